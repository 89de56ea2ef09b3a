#pragma once

#include <string>
#include <vector>

#include "clog/results/groups.hpp"
#include "clog/store/run_table.hpp"

namespace clog::results {

/// Which of the parameters that all groups share are named above their table.
enum class SharedParameters { unusual, all };

/// One line per group, with what the groups differ in, for people.
/// Where groups have a laboratory, here and below, lengths, speeds and times are in its units, too.
std::string to_text(const std::vector<Group>& groups, double confidence, SharedParameters shared);
/// All fields of every group.
std::string to_csv(const std::vector<Group>& groups);
/// All fields of every group, its P(r), and where the rows came from.
/// @param provenance  of the sweep
std::string to_json(const std::vector<Group>& groups, double confidence, const store::Provenance& provenance);

}  // namespace clog::results

#pragma once

#include <string>
#include <vector>

#include "clog/results/groups.hpp"
#include "clog/results/mixture.hpp"
#include "clog/store/run_table.hpp"

namespace clog::results {

/// Selects which parameters with equal values in all groups are named above the table: all, or only those
/// with an unusual value.
enum class SharedParameters { unusual, all };

/// A printed table: one line per group, with the parameters in which groups differ. If groups have a
/// laboratory, this function, to_csv() and to_json() also print lengths, speeds and times in laboratory
/// units.
std::string to_text(const std::vector<Group>& groups, double confidence, SharedParameters shared);
/// All fields of every group.
std::string to_csv(const std::vector<Group>& groups);
/// All fields of every group, its P(r), and the origin of the rows. @param provenance  of the sweep; @param
/// mixture  mixture of some of the groups; nullptr: none
std::string to_json(const std::vector<Group>& groups, double confidence, const store::Provenance& provenance,
                    const Mixture* mixture = nullptr);

}  // namespace clog::results

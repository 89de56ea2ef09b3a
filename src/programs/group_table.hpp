#pragma once

#include <string>
#include <vector>

#include "groups.hpp"

namespace clog {

/// One line per group, with what the groups differ in, for people.
std::string to_text(const std::vector<Group>& groups, double confidence);
/// All fields of every group.
std::string to_csv(const std::vector<Group>& groups);
/// All fields of every group, and its P(r).
std::string to_json(const std::vector<Group>& groups, double confidence);

}  // namespace clog

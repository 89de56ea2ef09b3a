#pragma once

#include <string>
#include <vector>

#include "clog/results/groups.hpp"

namespace clog::results {

/// Explains below the table its letters, stars and columns, and counts the runs that it lacks.
/// @param named  whether each of group_columns() is a column of the table or a word above it
std::string notes_below(const std::vector<Group>& groups, const std::vector<bool>& named);

}  // namespace clog::results

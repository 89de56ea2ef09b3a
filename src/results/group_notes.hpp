#pragma once

#include <string>
#include <vector>

#include "clog/results/groups.hpp"

namespace clog::results {

/// The notes below the table. They explain its letters, stars and columns, and give the number of runs that
/// it does not include.
/// @param named  for each of group_columns(), whether the table has it as a column or names it above the
/// columns
std::string notes_below(const std::vector<Group>& groups, const std::vector<bool>& named);

}  // namespace clog::results

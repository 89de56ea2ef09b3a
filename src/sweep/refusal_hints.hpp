#pragma once

#include "clog/core/parameters/refusal.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::sweep {

/// Explains what the user may have meant by a refused value: another list, or a decimal instead of a list.
/// Empty if neither is likely.
/// @param lists  the settings with all lists of the sweep; `branch` has only one value of each list of words
std::string hint_at_list(const Settings& branch, const Settings& lists, const Refusal& refusal);
/// The refusal of a point. If the refused key has one value for all points, the remedy is to replace this
/// value by a column of the points.
/// @param common  settings with the points
std::string refusal_of_point(const Settings& common, std::size_t point, const Refusal& refusal);

}  // namespace clog::sweep

#pragma once

#include "clog/core/parameters/refusal.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::sweep {

/// Why a check refused a value although the user may have meant something possible: another list, or a
/// decimal instead of a list. Empty if neither.
/// @param lists  all lists of the sweep, of which a branch has one value if they are words
std::string hint_at_list(const Settings& branch, const Settings& lists, const Refusal& refusal);
/// The refusal of a point. If it is about a key that is given for all points, the remedy is a column of it,
/// in place of a value that other points have.
/// @param common  settings with the points
std::string refusal_of_point(const Settings& common, std::size_t point, const Refusal& refusal);

}  // namespace clog::sweep

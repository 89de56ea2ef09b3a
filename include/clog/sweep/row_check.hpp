#pragma once

#include <string>

#include "clog/sweep/run_row.hpp"

namespace clog::sweep {

/// Describes the first impossible value of a row: a parameter that no run can have, a number that is not
/// finite, or a result that contradicts another result or physics. Empty if all values are possible. Unknown
/// values, which rows of older file formats have, are accepted.
std::string fault_of(const RunRow& row);

/// Largest possible distance from the release in the time of this row [sigma].
///
/// Drag takes energy from a droplet at a rate of at least b_inf v^2, where v is the speed of its centre and
/// b_inf = M g/V_t. Only gravity and the energy U at the release supply energy, so b_inf (integral of v^2) <=
/// M g x + U. A path of length r in the time t has (integral of v^2) >= r^2/t, and x <= r. Therefore r <= V_t
/// t + U/(M g).
double farthest_distance(const RunRow& row);

}  // namespace clog::sweep

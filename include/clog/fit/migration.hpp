#pragma once

#include <span>

namespace clog::fit {

/// Displacement of one run along and across the flow [sigma].
struct Displacement {
  double along;
  double across;
};

/// Lateral displacement per distance travelled, the tangent of the migration angle.
struct Migration {
  double slope = 0;           ///< NaN if no run went far enough, and for distances that are not finite
  double standard_error = 0;  ///< from the scatter between runs; NaN for fewer than two runs
};

/// Distance that a run must travel to show the direction of migration [sigma]. Runs that travelled less have
/// no mean speed, either.
inline constexpr double shortest_migration = 0.5;

/// Ratio of two sums over the runs that went at least shortest_migration: (sum of across)/(sum of along). In
/// this ratio of sums, short runs have little weight; their own ratios scatter widely. The standard error is
/// the linearised error of a ratio estimate (Cochran, Sampling Techniques, ch. 6).
Migration fit_migration(std::span<const Displacement> runs);

}  // namespace clog::fit

#pragma once

#include <span>

namespace clog::fit {

/// Mean over runs, with the standard error of that mean from the scatter between runs.
struct MeanSpeed {
  int num_runs = 0;           ///< runs that have a speed
  double mean = 0;            ///< NaN for no runs
  double standard_error = 0;  ///< NaN for fewer than two
};

/// @param speeds  one per run, in any unit; NaN (a run too short to have a speed) is excluded
MeanSpeed fit_mean_speed(std::span<const double> speeds);

/// Distance and duration of one run, in any units.
struct Travel {
  double distance;
  double time;
};

/// Speed of all runs together, (sum of distances)/(sum of times), which weighs a run by its time. The error
/// is the jackknife error over runs, sqrt((n - 1)/n sum (R_i - mean)^2), where R_i is the ratio without run
/// i. NaN if a sum is not finite.
/// @param runs  one entry for each run; runs with a NaN are excluded
MeanSpeed fit_pooled_speed(std::span<const Travel> runs);

}  // namespace clog::fit

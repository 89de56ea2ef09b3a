#pragma once

#include <span>

namespace clog::fit {

/// Mean over runs, with the standard error of that mean from the scatter between runs.
struct MeanSpeed {
  int num_runs = 0;           ///< that have a speed
  double mean = 0;            ///< NaN for no runs
  double standard_error = 0;  ///< NaN for fewer than two
};

/// @param speeds  one per run, in any unit; NaN (a run too short to have a speed) is left out
MeanSpeed fit_mean_speed(std::span<const double> speeds);

}  // namespace clog::fit

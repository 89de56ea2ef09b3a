#pragma once

#include <cstdint>
#include <span>

namespace clog::results {

/// The cost of one run so far. Work is counted in steps times vertices.
struct RunCost {
  std::int64_t parameter_set = 0;
  double begin_seconds = 0;  ///< time for sampling the obstacles and releasing the droplet
  double seconds = 0;        ///< time since the release
  double work = 0;           ///< work done in these seconds
  double longest_work = 0;   ///< total work of the run if it lasts to max-time
  bool is_over = false;
};

/// Runs of one parameter set that have not begun.
struct WaitingRuns {
  std::int64_t parameter_set = 0;
  std::int64_t number = 0;
  double longest_work = 0;  ///< the work of each run if it lasts to max-time
};

/// Computing time of a whole sweep, or of its unfinished part [s].
struct SweepCost {
  double seconds_per_work = 0;
  double bound = 0;  ///< the cost if every run lasts to max-time
  /// The estimate, and its approximate 95 % interval.
  double expected = 0;
  double lower = 0;
  double upper = 0;
};

/// Estimates the cost of a sweep from a sample of its runs. The sample is treated as random.
///
/// The remaining time of unfinished runs is estimated from late ends only, because early ends say little
/// about the remaining time. The end of a run is late if the run has lasted at least half as long as the
/// shortest unfinished run. The lower limit assumes that late ends are exponentially distributed. The upper
/// limit assumes that the ends come from a mixture of short and long runs, and that ends become rarer with
/// time. The estimate is the geometric mean of both limits.
///
/// If no run of a parameter set has ended, the upper limit assumes that all its runs last to max-time. The
/// estimate assumes that every order of magnitude of the remaining time is equally likely. The interval
/// combines the uncertainty of these assumptions with the sampling error.
/// @param sample  not empty; at least one run has done work and taken time
/// @param all_work  work of all runs of the sweep, if every run lasts to max-time
SweepCost sweep_cost(std::span<const RunCost> sample, double all_work, std::int64_t num_runs);

/// Estimates the remaining cost of a sweep from all its runs that have begun. These runs are not a random
/// sample, because long runs start first. So each parameter set is estimated separately, by the method of
/// sweep_cost(). The remaining time of a set's unfinished runs follows from the runs of this set if one of
/// these has ended, otherwise from all runs. For a set without a started run, the ratio of estimate to bound
/// is taken from the other sets, and the error is as large as the estimate.
/// @param begun  not empty; at least one run has done work and taken time
SweepCost cost_left(std::span<const RunCost> begun, std::span<const WaitingRuns> waiting);

}  // namespace clog::results

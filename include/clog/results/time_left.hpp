#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "clog/sweep/run_row.hpp"

namespace clog::results {

/// Remaining time of a sweep, as a range [s].
struct TimeLeft {
  bool is_known = false;
  double shortest = 0;
  double longest = 0;

  std::string text() const;
};
/// Runs that differ in their seed only.
struct SetTimes {
  std::int64_t num_finished = 0;
  std::int64_t num_running = 0;
  std::int64_t num_waiting = 0;
  double seconds = 0;  ///< total time of the finished runs, and of the running runs so far

  /// Adds a run of the set that has begun, with its cost so far.
  void count(const sweep::RunRow& row);
  /// Expected time of a run: the mean of an exponential distribution, fitted to the finished runs and to the
  /// running runs, which are censored. Infinite without a finished run.
  double mean_seconds() const;
};
/// Estimates the remaining time of a sweep. Short runs end first, so the mean over finished runs alone is too
/// small. Therefore running runs count as censored, see SetTimes::mean_seconds(). Each parameter set has a
/// separate mean. A set without a finished run gets the mean of all sets, with an equally large error.
///
/// The remaining time is the time for each rank's share of the waiting runs, plus a tail in which the W ranks
/// run out of tasks one by one. The tail lasts as long as the longest of W exponential times, which is on
/// average 1 + 1/2 + ... + 1/W times their mean. The range is the 80 % interval that results from the errors
/// of the means.
TimeLeft time_left(std::span<const SetTimes> sets, std::size_t num_ranks);

}  // namespace clog::results

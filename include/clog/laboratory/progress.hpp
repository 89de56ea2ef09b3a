#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

#include "clog/console/status_line.hpp"
#include "clog/fit/calibration.hpp"

namespace clog::laboratory {

/// Tells on the standard error how far the calibration of some trials is; from several threads. On a terminal
/// the line goes when all is done.
class CalibrationProgress {
 public:
  explicit CalibrationProgress(std::size_t num_trials);
  void tried(std::size_t trial, const fit::CalibrationAttempt& attempt);
  void ended();
  /// Describes the best trial so far in words.
  std::string best(std::size_t trial) const;
  void finish() { status_.wipe(); }

 private:
  using Clock = std::chrono::steady_clock;

  mutable std::mutex mutex_;
  console::StatusLine status_;
  Clock::time_point begin_ = Clock::now();
  std::vector<fit::CalibrationAttempt> best_;  ///< of each trial
  int num_simulations_ = 0;
  int num_ended_ = 0;

  std::string line() const;
};

}  // namespace clog::laboratory

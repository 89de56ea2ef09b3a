#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

#include "status_line.hpp"

namespace clog {

/// Tells on the standard error how far the calibration of some trials is; from several threads. On a terminal
/// the line goes when all is done.
class CalibrationProgress {
 public:
  explicit CalibrationProgress(std::size_t num_trials);
  /// A simulation for this trial had this Delta_v.
  void tried(std::size_t trial, double delta);
  void ended();
  void finish() { status_.wipe(); }

 private:
  using Clock = std::chrono::steady_clock;

  std::mutex mutex_;
  StatusLine status_;
  Clock::time_point begin_ = Clock::now();
  std::vector<double> least_deltas_;  ///< of each trial
  int num_simulations_ = 0;
  int num_ended_ = 0;

  std::string line() const;
};

}  // namespace clog

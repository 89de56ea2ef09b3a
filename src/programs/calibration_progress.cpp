#include "calibration_progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>

#include "clog/sweep/value_list.hpp"
#include "duration.hpp"

namespace clog {

CalibrationProgress::CalibrationProgress(std::size_t num_trials)
    : status_(std::cerr, StatusLine::standard_error()),
      least_deltas_(num_trials, std::numeric_limits<double>::infinity()) {}

void CalibrationProgress::tried(std::size_t trial, double delta) {
  const std::scoped_lock lock(mutex_);
  ++num_simulations_;
  least_deltas_[trial] = std::min(least_deltas_[trial], delta);
  if (status_.is_due()) status_.renew(line());
}

void CalibrationProgress::ended() {
  const std::scoped_lock lock(mutex_);
  ++num_ended_;
}

std::string CalibrationProgress::line() const {
  std::string text = sweep::counted(num_simulations_, "simulation");
  if (least_deltas_.size() > 1)
    text += ", " + std::to_string(num_ended_) + "/" + std::to_string(least_deltas_.size()) + " trials done";
  const double worst = *std::max_element(least_deltas_.begin(), least_deltas_.end());
  if (std::isfinite(worst)) {
    char delta[48];
    std::snprintf(delta, sizeof delta, ", Delta_v down to %.3g", worst);
    text += delta;
  }
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
  return text + ", " + readable_duration(elapsed) + " so far";
}

}  // namespace clog

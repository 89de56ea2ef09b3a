#include "clog/laboratory/progress.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include "clog/console/duration.hpp"
#include "clog/console/status_line.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::laboratory {
namespace {

bool is_nearer(const fit::CalibrationAttempt& a, const fit::CalibrationAttempt& b) {
  return a.delta < b.delta;
}

std::string text_of(const fit::CalibrationAttempt& best) {
  if (!std::isfinite(best.delta)) return "no simulation is over";
  return fmt::format("Delta_v down to {:.3g}, with Gamma = {:.4g}, b_0/b_inf = {:.4g}", best.delta,
                     best.line_tension, best.near_wall_drag);
}

}  // namespace

CalibrationProgress::CalibrationProgress(std::size_t num_trials)
    : status_(std::cerr, console::StatusLine::standard_error()),
      best_(num_trials, {.delta = std::numeric_limits<double>::infinity()}) {}

void CalibrationProgress::tried(std::size_t trial, const fit::CalibrationAttempt& attempt) {
  const std::scoped_lock lock(mutex_);
  ++num_simulations_;
  best_[trial] = std::min(attempt, best_[trial], is_nearer);
  if (status_.is_due()) status_.renew(line());
}

void CalibrationProgress::ended() {
  const std::scoped_lock lock(mutex_);
  ++num_ended_;
}

std::string CalibrationProgress::best(std::size_t trial) const {
  const std::scoped_lock lock(mutex_);
  return text_of(best_[trial]);
}

std::string CalibrationProgress::line() const {
  std::string text = sweep::counted(num_simulations_, "simulation");
  if (best_.size() > 1) text += fmt::format(", {}/{} trials done", num_ended_, best_.size());
  const fit::CalibrationAttempt& worst = *std::max_element(best_.begin(), best_.end(), is_nearer);
  if (std::isfinite(worst.delta)) text += ", " + text_of(worst);
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
  return fmt::format("{}, {} so far", text, console::readable_duration(elapsed));
}

}  // namespace clog::laboratory

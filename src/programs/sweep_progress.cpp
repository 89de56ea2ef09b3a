#include "sweep_progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <vector>

#include "clog/fit/clogging_length.hpp"

namespace clog {
namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::string readable(double seconds) {
  char text[32];
  if (seconds < 90)
    std::snprintf(text, sizeof text, "%.0f s", seconds);
  else if (seconds < 90 * 60)
    std::snprintf(text, sizeof text, "%.0f min", seconds / 60);
  else if (seconds < 48 * 3600)
    std::snprintf(text, sizeof text, "%.1f h", seconds / 3600);
  else
    std::snprintf(text, sizeof text, "%.1f days", seconds / 86400);
  return text;
}

}  // namespace

SweepProgress::SweepProgress(std::ostream& out, Screen screen, std::int64_t num_tasks,
                             int num_computing_ranks)
    : out_(out), screen_(screen), num_tasks_(num_tasks), num_ranks_(num_computing_ranks) {}

void SweepProgress::started(std::int64_t task) { running_[task] = Clock::now(); }

void SweepProgress::ended(const sweep::RunRow& row) {
  running_.erase(row.task);
  ++ended_by_status_[std::string(row.status.view())];
  ++num_ended_;
  finished_seconds_ += row.wall_seconds;
}

void SweepProgress::tick() {
  const double interval = screen_ == Screen::terminal ? 0.2 : 10;
  if (seconds_since(last_print_) >= interval) print(line());
}

void SweepProgress::finish() {
  print(line());
  if (screen_ == Screen::terminal) out_ << std::endl;
}

void SweepProgress::print(const std::string& text) {
  last_print_ = Clock::now();
  if (screen_ == Screen::terminal)
    out_ << '\r' << text << "\x1b[K" << std::flush;  // to the left edge; then clear what an older line left
  else
    out_ << text << std::endl;
}

std::string SweepProgress::line() const {
  const auto count = [this](std::string_view status) {
    const auto found = ended_by_status_.find(status);
    return std::to_string(found == ended_by_status_.end() ? 0 : found->second);
  };
  std::string text = std::to_string(num_ended_) + "/" + std::to_string(num_tasks_) + " done, " +
                     std::to_string(running_.size()) + " running, " + count("clogged") + " clogged, " +
                     count("flowing") + " flowing";
  if (count("failed") != "0") text += ", " + count("failed") + " failed";
  if (count("interrupted") != "0") text += ", " + count("interrupted") + " interrupted";
  const double elapsed = seconds_since(begin_);
  if (num_ended_ > 0) {
    char rate[48];
    std::snprintf(rate, sizeof rate, ", %.3g runs/min", 60 * static_cast<double>(num_ended_) / elapsed);
    text += rate;
  }
  return text + ", " + readable(elapsed) + " so far" + time_left();
}

/// Short runs end first, so the mean over finished runs alone is too small: running ones count as censored,
/// as for the clogging length. What remains is then a share of the waiting runs for every rank, and a tail in
/// which the ranks run dry one by one (the largest of W exponential times is 1 + 1/2 + ... + 1/W means).
std::string SweepProgress::time_left() const {
  if (num_ended_ == num_tasks_) return "";
  if (num_ended_ == 0) return ", time left not known yet";
  std::vector<fit::Observation> durations(num_ended_,
                                          {finished_seconds_ / static_cast<double>(num_ended_), true});
  for (const auto& [task, begin] : running_) durations.push_back({seconds_since(begin), false});
  const fit::CloggingLength mean = fit::fit_clogging_length(durations, 0.8);
  const auto waiting =
      static_cast<double>(num_tasks_ - num_ended_ - static_cast<std::int64_t>(running_.size()));
  double tail = 0;
  for (std::size_t i = 1; i <= running_.size(); ++i) tail += 1.0 / static_cast<double>(i);
  const double means_left = waiting / num_ranks_ + tail;
  return ", " + readable(means_left * mean.lower) + " to " + readable(means_left * mean.upper) + " left";
}

}  // namespace clog

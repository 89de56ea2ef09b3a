#include "clog/results/activity.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "clog/console/json_text.hpp"

namespace clog::results {
namespace {

constexpr std::size_t most_intervals = 200;
constexpr std::ptrdiff_t most_sessions = 50;

double to_milliseconds(double number) {
  constexpr double steps = 1000;
  return std::round(number * steps) / steps;
}

}  // namespace

/// Merges pairs of intervals.
void Activity::lengthen() {
  interval_ *= 2;
  for (std::size_t i = 0; 2 * i < busy_.size(); ++i)
    busy_[i] = busy_[2 * i] + (2 * i + 1 < busy_.size() ? busy_[2 * i + 1] : 0);
  busy_.resize((busy_.size() + 1) / 2);
}

void Activity::count_until(double now) {
  while (now > interval_ * static_cast<double>(most_intervals)) lengthen();
  const auto needed = static_cast<std::size_t>(std::ceil(now / interval_));
  if (busy_.size() < needed) busy_.resize(needed);
  for (auto i = static_cast<std::size_t>(last_ / interval_); i < needed; ++i) {
    const double begin = std::max(last_, static_cast<double>(i) * interval_);
    const double end = std::min(now, static_cast<double>(i + 1) * interval_);
    busy_[i] += num_busy_ * std::max(0.0, end - begin);
  }
  busy_seconds_ += num_busy_ * (now - last_);
  tail_busy_seconds_ += num_busy_ * (now - last_);
  last_ = now;
}

void Activity::started(double now) {
  count_until(now);
  ++num_busy_;
  last_start_ = now;
  tail_busy_seconds_ = 0;
}

void Activity::ended(double now) {
  count_until(now);
  --num_busy_;
}

std::string Activity::line(const std::string& start_time, double now) const {
  Activity all = *this;
  all.count_until(now);
  nlohmann::ordered_json busy = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < all.busy_.size(); ++i) {
    const double length = std::min(all.interval_, now - static_cast<double>(i) * all.interval_);
    busy.push_back(to_milliseconds(length > 0 ? all.busy_[i] / length : 0));
  }
  const nlohmann::ordered_json line = {
      {"start_time", start_time},
      {"ranks", num_ranks_},
      {"seconds", to_milliseconds(now)},
      {"stretch", all.interval_},
      {"busy", busy},
      {"idle_seconds", to_milliseconds(std::max(0.0, num_ranks_ * now - all.busy_seconds_))},
      {"tail_seconds",
       to_milliseconds(std::max(0.0, num_ranks_ * (now - last_start_) - all.tail_busy_seconds_))},
      {"restarts", num_restarts_}};
  return console::json_text(line, -1);
}

std::string with_session(const std::string& lines, const std::string& line) {
  std::string all = lines;
  while (std::ranges::count(all, '\n') >= most_sessions) all.erase(0, all.find('\n') + 1);
  return all + line;
}

}  // namespace clog::results

#include "clog/results/time_left.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "clog/console/duration.hpp"
#include "clog/fit/clogging_length.hpp"

namespace clog::results {

std::string TimeLeft::text() const {
  return is_known
             ? console::readable_duration(shortest) + " to " + console::readable_duration(longest) + " left"
             : "time left not known yet";
}

void SetTimes::count(const sweep::RunRow& row) {
  ++(sweep::is_unfinished(row.status) ? num_running : num_finished);
  seconds += sweep::cost_seconds(row);
}

double SetTimes::mean_seconds() const {
  if (num_finished == 0) return std::numeric_limits<double>::infinity();
  return seconds / static_cast<double>(num_finished);
}

TimeLeft time_left(std::span<const SetTimes> sets, std::size_t num_ranks) {
  SetTimes all;
  for (const SetTimes& set : sets) {
    all.num_finished += set.num_finished;
    all.num_running += set.num_running;
    all.seconds += set.seconds;
  }
  if (all.num_finished == 0) return {};
  double tail = 0;
  for (std::int64_t i = 1; i <= all.num_running; ++i) tail += 1 / static_cast<double>(i);
  double seconds = 0, variance = 0;
  for (const SetTimes& set : sets) {
    double means_left = static_cast<double>(set.num_waiting) / static_cast<double>(num_ranks);
    if (set.num_running > 0)
      means_left += tail * static_cast<double>(set.num_running) / static_cast<double>(all.num_running);
    const double left = means_left * (set.num_finished > 0 ? set : all).mean_seconds();
    seconds += left;
    variance += left * left / static_cast<double>(std::max<std::int64_t>(set.num_finished, 1));
  }
  if (seconds == 0) return {true, 0, 0};
  const double factor = std::exp(fit::normal_deviate(0.8) * std::sqrt(variance) / seconds);
  return {true, seconds / factor, seconds * factor};
}

}  // namespace clog::results

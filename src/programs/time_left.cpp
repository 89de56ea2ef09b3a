#include "time_left.hpp"

#include <vector>

#include "clog/fit/clogging_length.hpp"
#include "duration.hpp"

namespace clog {

std::string TimeLeft::text() const {
  return is_known ? readable_duration(shortest) + " to " + readable_duration(longest) + " left"
                  : "time left not known yet";
}

TimeLeft time_left(std::span<const double> finished, std::span<const double> running, double num_waiting,
                   std::size_t num_ranks) {
  if (finished.empty()) return {};
  std::vector<fit::Observation> durations;
  for (const double seconds : finished) durations.push_back({seconds, true});
  for (const double seconds : running) durations.push_back({seconds, false});
  const fit::CloggingLength mean = fit::fit_clogging_length(durations, 0.8);
  double tail = 0;
  for (std::size_t i = 1; i <= running.size(); ++i) tail += 1.0 / static_cast<double>(i);
  const double means_left = num_waiting / static_cast<double>(num_ranks) + tail;
  return {true, means_left * mean.interval.lower, means_left * mean.interval.upper};
}

}  // namespace clog

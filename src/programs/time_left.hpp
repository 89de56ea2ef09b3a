#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace clog {

/// How long a sweep still takes, as a range [s].
struct TimeLeft {
  bool is_known = false;
  double shortest = 0;
  double longest = 0;

  std::string text() const;
};
/// Short runs end first, so the mean over finished runs alone is too small: running ones count as censored,
/// as for the clogging length. What remains is then a share of the waiting runs for every rank, and a tail in
/// which the ranks run dry one by one (the largest of W exponential times is 1 + 1/2 + ... + 1/W means).
/// @param finished, running  how long they took, or have taken [s]
TimeLeft time_left(std::span<const double> finished, std::span<const double> running, double num_waiting,
                   std::size_t num_ranks);

}  // namespace clog

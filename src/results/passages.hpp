#pragma once

#include <span>
#include <vector>

#include "clog/results/groups.hpp"

namespace clog::results {

/// The x at which a droplet of a device was released, and the x that it reached, in the coordinates of the
/// device's circles [sigma].
struct Arrival {
  double begin;
  double x;
  bool is_final;  ///< false: the droplet was still moving
};

/// The fractions of droplets that passed two kinds of lines: the rows of posts downstream of the entrance,
/// and the exit. A droplet counts only at lines downstream of its release.
/// @param lines  x of lines to use instead of the rows of posts; the x of a row is the x of the posts'
/// centres
std::vector<Passage> passages_of(const RunParameters& device, std::span<const Arrival> arrivals,
                                 std::span<const double> lines, double confidence);

}  // namespace clog::results

#pragma once

#include <Eigen/Core>

#include "clog/core/droplet/droplet_state.hpp"

namespace clog {

/// Channels and walls have no periodic images: the box is only where their coordinates live [sigma].
inline constexpr double open_box = 256;
inline Eigen::Array2d middle_of_open_box() { return {open_box / 2, open_box / 2}; }

/// A droplet at rest.
/// @param droplet  around the origin
/// @param place    of its centre
DropletState at_rest(Eigen::ArrayXd droplet, const Eigen::Array2d& place);

}  // namespace clog

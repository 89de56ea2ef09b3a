#pragma once

#include <Eigen/Core>
#include <span>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/droplet/hold.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// How a droplet at rest lies among obstacles.
/// @param position       counter-clockwise polygon, all x then all y [sigma]
/// @param obstacles      all that may touch it, periodic images included, in the same coordinates
/// @param contact_range  distance from an obstacle's surface at which contact begins [sigma]
/// @param links_per_edge  the given polygon's edges for one edge of the droplet's mesh: 2 if it is refined
ClogGeometry clog_geometry(const Eigen::ArrayXd& position, std::span<const Obstacle> obstacles,
                           double contact_range, int links_per_edge = 1);
/// The same for a droplet in a periodic array, from the interface that walls meet.
/// @param dp  resolved
ClogGeometry clog_geometry(const DropletState& state, const ObstacleArray& array, const DpParameters& dp);

}  // namespace clog

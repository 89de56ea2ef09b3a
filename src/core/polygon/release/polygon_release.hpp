#pragma once

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// Puts a small circle into the void nearest to the centre, and grows it to full size in stages. Each stage
/// ends with a relaxation. In this way, no obstacle is ever inside the droplet. (Minimising the energy would
/// not push out an obstacle inside the droplet: if it touches no vertex, it does not contribute to the
/// energy.)
/// @param run  resolved
/// @throws Error if there is no room, or the droplet does not relax
DropletState release_polygon(const RunParameters& run, const ObstacleArray& obstacles);

}  // namespace clog

#pragma once

#include <string>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// Refuses a box in which the droplet would meet its own periodic image across the flow. @throws Error
void check_box(const ObstacleParameters& obstacles);

/// Checks gap and diameter of random arrays and lattices. @throws Error
void check_spacing(const RunParameters& run);

/// The density as text, as in the key `obstacle-density`: `0.35`, `12.5%`, `saturated`.
std::string density_text(const ObstacleDensity& density);

/// Diameter of the sharpest bend of the interface, around the smallest obstacle.
double smallest_diameter(const RunParameters& run);

/// Releases the droplet in the void nearest to the centre. @throws Error if there is no room for it
DropletState release_in_void(const RunParameters& run, const ObstacleArray& obstacles);

/// Infinite, because a droplet never reaches the end of a periodic array, and never passes a wall.
double infinite_passing_distance(const RunParameters& run, const Eigen::Array2d& start);

}  // namespace clog

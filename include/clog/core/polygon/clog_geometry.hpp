#pragma once

#include <Eigen/Core>
#include <vector>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/droplet/hold.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// All obstacles that may touch a droplet, periodic images included, in the droplet's coordinates.
struct Surroundings {
  std::vector<Obstacle> circles;
  std::vector<Wedge> walls;
  /// An edge that touches a circle through other parts of the interface, and this circle, enlarged by the
  /// films in between; see WallContacts.
  struct Layer {
    Eigen::Index edge;
    Obstacle circle;
  };
  std::vector<Layer> layers{};
};

/// Geometry of a droplet at rest among obstacles.
/// @param position  counter-clockwise polygon, all x then all y [sigma]
/// @param contact_range  distance from an obstacle's surface at which contact begins [sigma]
/// @param links_per_edge  number of the polygon's edges for one edge of the droplet's mesh: 2 for a refined
/// polygon
ClogGeometry clog_geometry(const Eigen::ArrayXd& position, const Surroundings& around, double contact_range,
                           int links_per_edge = 1);
/// Geometry of a droplet in an array, from the droplet's refined interface. @param dp  resolved
ClogGeometry clog_geometry(const DropletState& state, const ObstacleArray& array, const DpParameters& dp);

}  // namespace clog

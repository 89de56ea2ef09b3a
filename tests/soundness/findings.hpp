#pragma once

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog::soundness {

/// Measures of a deformable droplet at one moment, or the worst of several moments.
struct Findings {
  int crossings = 0;   ///< see num_self_crossings()
  int enclosed = 0;    ///< obstacles whose centre lies inside the droplet
  double overlap = 0;  ///< depth of an obstacle's surface in the interface [vertex diameters, of 128 at most]
  double area_error = 0;  ///< |area/rest area - 1|
  double edge_ratio = 1;  ///< longest over shortest edge
  double perimeter = 0;   ///< in units of the circle's
  double shape = 1;       ///< shape parameter
  double substeps = 1;    ///< parts per time step, mean over an interval between two checks

  void keep_worst(const Findings& other);
};

/// Contact is soft: the interface may come nearer to an obstacle's centre than the radius by this much
/// [vertex diameters]. A depth allowed for 128 vertices is also allowed for a finer mesh.
inline constexpr double deepest_overlap = 0.25;
/// Largest accepted relative error of the area.
inline constexpr double largest_area_error = 0.05;

bool is_sound(const Findings& findings);

/// Checks every edge of the refined interface (see refined()) and every obstacle near the droplet, without
/// the contact lists of the forces, so it also finds obstacles missing from those. Does not change
/// `substeps`.
Findings look_at(const DropletState& state, const ObstacleArray& obstacles);

}  // namespace clog::soundness

#pragma once

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog::soundness {

/// Measures of a deformable droplet at one moment, or the worst values at several moments.
struct Findings {
  int crossings = 0;  ///< Number of self-crossings, see num_self_crossings().
  int enclosed = 0;   ///< Number of obstacles with a centre inside the droplet.
  /// Depth of an obstacle's surface inside the interface [vertex diameters]. For meshes finer than 128
  /// vertices, the unit is the vertex diameter of 128 vertices.
  double overlap = 0;
  double area_error = 0;  ///< Relative error of the area, |area/rest area - 1|.
  double edge_ratio = 1;  ///< Length of the longest edge divided by that of the shortest edge.
  double perimeter = 0;   ///< Perimeter divided by the perimeter of a circle.
  double shape = 1;       ///< Shape parameter.
  /// Number of parts into which a time step is split, averaged over the interval between two checks.
  double substeps = 1;

  void keep_worst(const Findings& other);
};

/// Largest accepted depth of an obstacle's surface inside the interface [vertex diameters]. Contact is soft,
/// so this depth is not zero. A depth that is accepted for 128 vertices is also accepted for a finer mesh.
inline constexpr double deepest_overlap = 0.25;
/// Largest accepted relative error of the area.
inline constexpr double largest_area_error = 0.05;

bool is_sound(const Findings& findings);

/// Measures a droplet. Every edge of the refined interface (see refined()) is compared with every obstacle
/// near the droplet. This does not use the contact lists of the forces, so it also finds obstacles that are
/// missing in these lists. `substeps` keeps its default.
Findings look_at(const DropletState& state, const ObstacleArray& obstacles);

}  // namespace clog::soundness

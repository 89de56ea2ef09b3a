#pragma once

#include <Eigen/Core>
#include <span>

#include "clog/core/droplet/wall_anchor.hpp"
#include "clog/core/world/wedge.hpp"

namespace clog {

/// The wall's closest point to a vertex, relative to the wall's centre. If the vertex moves in the direction
/// `along`, this point moves `gradient` times as far.
struct WallFoot {
  Eigen::Array2d point, along;
  double gradient;
};
/// @param wedges  of the scene @param from_centre  vector from the wall to the vertex
WallFoot foot_on(const WallPlace& wall, std::span<const Wedge> wedges, const Eigen::Array2d& from_centre);

/// A vertex that a wall pushes, directly or through films.
struct WallTouch {
  int vertex;
  WallPlace wall;
  WallFoot foot;
  double push;    ///< force of the contacts on the vertex, away from the wall [g rho sigma^2]
  double wetted;  ///< length of the wetted part of the interface that belongs to the vertex [sigma]
};

/// A droplet's vertices. `x` and `y` may be read from [-1] to [size + WallContacts::edges_per_group - 1]: the
/// entries beyond the ends repeat the contour.
struct Contour {
  int size;
  const double *x, *y;
  Eigen::Array2d place(int vertex) const { return {x[vertex], y[vertex]}; }
};

}  // namespace clog

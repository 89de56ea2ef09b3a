#pragma once

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/world/wedge.hpp"

namespace clog::kernel {

/// A wedge (see wedge.hpp) in the coordinates of the vertices.
struct WedgePlace {
  double x, y;  ///< place of the centre()
  double radius;
  double axis_x, axis_y;
  double cos, sin;  ///< cosine and sine of the half angle
};

inline WedgePlace place_in(const LocalFrame& frame, const Wedge& wedge) {
  const Eigen::Array2d centre = wedge.centre() - frame.origin - frame.image.cast<double>() * frame.period;
  return {.x = centre[0],
          .y = centre[1],
          .radius = wedge.radius,
          .axis_x = wedge.axis[0],
          .axis_y = wedge.axis[1],
          .cos = wedge.half_angle.cos,
          .sin = wedge.half_angle.sin};
}

}  // namespace clog::kernel

#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "clog/core/tools/portable_math.hpp"

namespace clog {

/// An angle with its cosine and sine, which are slow to compute.
struct Angle {
  double radians, cos, sin;
  Angle(double in_radians)
      : radians(in_radians), cos(portable::cos(in_radians)), sin(portable::sin(in_radians)) {}
};

/// Infinite convex wall: all points that, seen from the tip, are within `half_angle` of the axis. A circle
/// rounds the tip. With half_angle = pi/2 the wall is a half-plane. Two wedges with opposite tips form a
/// narrow channel (Cheng et al., Fig. 1).
struct Wedge {
  Eigen::Array2d tip{0, 0};                 ///< place in the box [sigma]; wedges have no periodic images
  Eigen::Array2d axis{1, 0};                ///< unit vector from the tip into the wall
  Angle half_angle = std::numbers::pi / 2;  ///< half of the opening angle, in (0, pi/2]

  double radius = 0;  ///< radius of the rounded tip [sigma]

  /// Centre of the rounded tip. The wall is everything within `radius` of a sharp wedge with its tip at this
  /// centre.
  Eigen::Array2d centre() const { return tip + radius * axis; }
  bool is_flat() const { return half_angle.radians >= std::numbers::pi / 2; }
};

/// Distance between a point and the surface of a wedge, and the direction of this surface.
struct WedgeDistance {
  double distance;        ///< distance to the nearest surface point, negative inside [sigma]
  Eigen::Array2d normal;  ///< unit vector from the wall to the point
};
/// @param point  relative to the wedge's centre() [sigma]
inline WedgeDistance distance_to(const Wedge& wedge, const Eigen::Array2d& point) {
  const Eigen::Array2d across_axis{-wedge.axis[1], wedge.axis[0]};
  const double along = (point * wedge.axis).sum();
  const double across = (point * across_axis).sum();
  const double side = across < 0 ? -1 : 1;
  const double c = wedge.half_angle.cos;
  const double s = wedge.half_angle.sin;
  const bool before_tip = along * c + std::abs(across) * s < 0;
  if (before_tip) {
    const double distance = std::hypot(along, across);
    return {distance - wedge.radius, point / distance};
  }
  return {std::abs(across) * c - along * s - wedge.radius, side * c * across_axis - s * wedge.axis};
}

}  // namespace clog

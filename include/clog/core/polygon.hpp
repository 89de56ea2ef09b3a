#pragma once

#include <Eigen/Core>

namespace clog {

/// Shape of a closed polygon given as one array, all x then all y, counter-clockwise.
struct PolygonShape {
  double area = 0;       ///< signed, positive for counter-clockwise [sigma^2]
  double perimeter = 0;  ///< [sigma]

  /// A = perimeter^2 / (4 pi area), 1 for a circle. Cheng et al., "Deformable particle model".
  double shape_parameter() const;
};

PolygonShape polygon_shape(const Eigen::ArrayXd& position);

/// Regular polygon of the given area around the origin, first vertex on +x, counter-clockwise: 2N
/// coordinates.
Eigen::ArrayXd regular_polygon(int num_vertices, double area);

/// Does the polygon enclose the point? Even-odd rule.
bool encloses(const Eigen::ArrayXd& position, double x, double y);

/// Distance from a point to the nearest point of the segment from `begin` to `end` [sigma].
double distance_to_segment(const Eigen::Array2d& point, const Eigen::Array2d& begin,
                           const Eigen::Array2d& end);

/// Area centroid [sigma].
Eigen::Array2d area_centroid(const Eigen::ArrayXd& position);

}  // namespace clog

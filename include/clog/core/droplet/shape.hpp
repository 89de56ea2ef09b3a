#pragma once

#include <Eigen/Core>

namespace clog {

/// The interface that walls meet is the polygon refined once by the four-point rule (Dubuc 1986; Dyn, Gregory
/// and Levin 1987): the middle of an edge becomes the middle of the cubic through its two vertices and their
/// two neighbours. A chord deviates from the curve through its ends by l^2/8 times the curvature; a refined
/// edge, half as long, deviates by a quarter of that. The middle is w (q_i + q_(i+1)) + w' (q_(i-1) +
/// q_(i+2)), with w = refined_near and w' = refined_far.
inline constexpr double refined_near = 9.0 / 16;
inline constexpr double refined_far = -1.0 / 16;

/// Largest distance that a middle can move if no vertex moves by more than 1.
inline constexpr double refined_sway = 2 * (refined_near - refined_far);

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

/// The polygon of vertices and middles in turn, 4N coordinates.
Eigen::ArrayXd refined(const Eigen::ArrayXd& position);

/// Whether the polygon encloses the point. Even-odd rule.
bool encloses(const Eigen::ArrayXd& position, double x, double y);

/// Number of pairs of edges without a common vertex that cross each other.
///
/// Edges cross if each has its ends strictly on both sides of the other; edges that only touch do not. Edges
/// with a common vertex meet only there, unless they lie exactly on top of each other, which rounding
/// prevents. If more than two edges fold back, other edges cross. Without a crossing and with a positive area
/// the contour winds once around every point inside it: no pocket of it encloses negative area. (The converse
/// does not hold: a contour may cross itself and wind twice around a part of its area.)
int num_self_crossings(const Eigen::ArrayXd& position);

/// Point of the segment from `begin` to `end` that is nearest to a point [sigma].
Eigen::Array2d nearest_on_segment(const Eigen::Array2d& point, const Eigen::Array2d& begin,
                                  const Eigen::Array2d& end);
/// Distance from a point to the nearest point of the segment from `begin` to `end` [sigma].
double distance_to_segment(const Eigen::Array2d& point, const Eigen::Array2d& begin,
                           const Eigen::Array2d& end);

/// Area centroid [sigma].
Eigen::Array2d area_centroid(const Eigen::ArrayXd& position);
/// The centroid's rate of change when the vertices move with these velocities.
Eigen::Array2d area_centroid_velocity(const Eigen::ArrayXd& position, const Eigen::ArrayXd& velocity);

}  // namespace clog

#pragma once

#include <Eigen/Core>

namespace clog {

/// Walls touch a refined interface. The four-point rule (Dubuc 1986; Dyn, Gregory and Levin 1987) refines the
/// polygon once: to each edge it adds the middle of a cubic. The cubic passes through the edge's two vertices
/// and their two other neighbours. The middle is w (q_i + q_(i+1)) + w' (q_(i-1) + q_(i+2)), with w =
/// refined_near and w' = refined_far. A chord of length l deviates from the curve through its ends by l^2/8
/// times the curvature. A refined edge is half as long, so its deviation is a quarter of that of the whole
/// edge.
inline constexpr double refined_near = 9.0 / 16;
inline constexpr double refined_far = -1.0 / 16;

/// Largest displacement of a middle if no vertex moves by more than 1.
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

/// The polygon refined by the four-point rule: vertices and middles alternate, which gives 4N coordinates.
Eigen::ArrayXd refined(const Eigen::ArrayXd& position);

/// Whether the polygon encloses the point, by the even-odd rule.
bool encloses(const Eigen::ArrayXd& position, double x, double y);

/// Number of pairs of edges without a common vertex that cross each other.
///
/// Two edges cross if the ends of each edge are strictly on opposite sides of the other edge. Edges that only
/// touch do not cross. Edges with a common vertex are not tested. They could meet elsewhere only if one edge
/// were exactly on top of the other, which rounding prevents. If the contour has no crossing and a positive
/// area, it winds once around every point inside it, so no pocket of it encloses negative area. (The converse
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

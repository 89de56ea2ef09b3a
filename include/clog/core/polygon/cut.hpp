#pragma once

#include <Eigen/Core>
#include <array>

#include "clog/core/polygon/neck.hpp"

namespace clog {

/// A polygon with the velocities of its vertices, both as all x, then all y.
struct MovingPolygon {
  Eigen::ArrayXd position;  ///< counter-clockwise, local [sigma]
  Eigen::ArrayXd velocity;  ///< [sqrt(sigma g)]
};

/// The two parts of a polygon on both sides of a neck.
///
/// Both parts have the ends of the neck as vertices. So the areas of the parts add up to the area of the
/// whole, and the parts' area centroids, weighted with their areas, average to the centroid of the whole. The
/// end of the neck on an edge moves with that edge. One common velocity is then added to both parts, so that
/// the mean velocities of their vertices, weighted with the areas, add up to the mean velocity of the whole.
/// (A droplet's mass is spread evenly over its vertices, and the mass of a part is proportional to its area.)
std::array<MovingPolygon, 2> cut(const MovingPolygon& whole, const Neck& neck);

/// The polygon with `num_vertices` vertices at equal distances along its contour. The first new vertex is at
/// the first old vertex. The polygon is then magnified about its area centroid, so that its area stays the
/// same. The mean velocity of the vertices stays the same, too.
MovingPolygon with_vertices(const MovingPolygon& polygon, int num_vertices);

}  // namespace clog

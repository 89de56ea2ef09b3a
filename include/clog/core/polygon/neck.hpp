#pragma once

#include <Eigen/Core>
#include <limits>

namespace clog {

/// Width of the thinnest neck of a polygon; infinite if it has none that is narrower than `below` [sigma].
///
/// A neck is a segment inside the polygon that joins two points of the contour. Its length is a local minimum
/// when either end moves along the contour. It divides the polygon into two lobes, each of which, as a
/// separate round drop, would be at least twice as wide as the neck. One end of such a segment is a vertex at
/// which the contour does not turn outwards, so only segments from these vertices are examined. A convex
/// contour therefore has no neck, whatever its number of vertices, except between parallel straight sides.
/// @param position  counter-clockwise, without self-crossings, all x then all y [sigma]
double thinnest_neck(const Eigen::ArrayXd& position, double below = std::numeric_limits<double>::infinity());

}  // namespace clog

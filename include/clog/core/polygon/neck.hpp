#pragma once

#include <Eigen/Core>
#include <limits>

namespace clog {

/// Width of the thinnest neck of a polygon; infinite if it has none that is narrower than `below` [sigma].
///
/// A neck is a segment between two points of the contour that lies inside, is a local minimum of the distance
/// between its ends when either of them moves along the contour, and cuts off parts that are both lobes: as a
/// drop of its own each would be at least twice as wide as the neck is. A convex contour has none, whatever
/// its number of vertices, but between parallel straight sides: where a segment inside is as short as it can
/// be, an end is a vertex at which the contour does not turn outwards. Those are the only ones looked at.
/// @param position  counter-clockwise, without self-crossings, all x then all y [sigma]
double thinnest_neck(const Eigen::ArrayXd& position, double below = std::numeric_limits<double>::infinity());

}  // namespace clog

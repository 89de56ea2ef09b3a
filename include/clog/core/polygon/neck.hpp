#pragma once

#include <Eigen/Core>
#include <limits>

namespace clog {

/// A neck of a polygon: the segment from a vertex to a point of an edge.
struct Neck {
  double width = std::numeric_limits<double>::infinity();  ///< infinite if there is no neck [sigma]
  Eigen::Index vertex = 0;
  Eigen::Index edge = 0;  ///< edge e joins vertices e and e + 1 (mod N)
  double place = 0;  ///< place of the neck's end on the edge: 0 at the edge's first vertex, 1 at its second
};

/// The thinnest neck of a polygon, if it is narrower than `below` [sigma].
///
/// A neck is a segment inside the polygon that joins two points of the contour. Its length is a local minimum
/// when either end moves along the contour. A neck divides the polygon into two lobes. Each lobe, if it were
/// a separate round drop, would be at least twice as wide as the neck. One end of such a segment is a vertex
/// at which the contour does not turn outwards, so only segments from these vertices are examined. Therefore
/// a convex contour with any number of vertices has no neck, except between parallel straight sides.
/// @param position  counter-clockwise, without self-crossings, all x then all y [sigma]
Neck thinnest_neck(const Eigen::ArrayXd& position, double below = std::numeric_limits<double>::infinity());

}  // namespace clog

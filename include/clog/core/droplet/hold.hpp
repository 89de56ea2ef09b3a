#pragma once

#include <limits>

#include "clog/core/tools/words.hpp"

namespace clog {

/// What holds a clogged droplet: obstacles over which it hangs, gaps that it does not pass, or both.
enum class ClogMechanism { none, wrapped, squeezed, hybrid };
template <>
struct Words<ClogMechanism> {
  static constexpr Worded<ClogMechanism> all[] = {{ClogMechanism::none, "none"},
                                                  {ClogMechanism::wrapped, "wrapped"},
                                                  {ClogMechanism::squeezed, "squeezed"},
                                                  {ClogMechanism::hybrid, "hybrid"}};
};

/// Geometry of a polygon at rest among obstacles; docs/explanation/clogged.md has the definitions.
/// The flow is along +x.
struct ClogGeometry {
  /// Fraction of the obstacles' upstream support that comes from wrapped obstacles; NaN without support.
  double wrapped_support = std::numeric_limits<double>::quiet_NaN();
  int num_wrapped = 0;  ///< touched obstacles that the droplet hangs over
  /// Number of gaps in front of the droplet. Two successive arcs (see num_arcs) on different obstacles have a
  /// gap between them if the chord from arc to arc faces downstream and at least one of the two obstacles
  /// supports the droplet.
  int num_gaps = 0;
  int num_arcs = 0;  ///< number of arcs; an arc is a chain of edges that touch one obstacle (post or wall)
  /// Largest part of the weight that the corners of the polygon can hold. Each wrapped obstacle contributes
  /// its part of the support times x^2/16, with x the length of the longest edge on the obstacle divided by
  /// the radius at which this edge lies. NaN without support.
  double mesh_hold = std::numeric_limits<double>::quiet_NaN();

  /// Wrapped if wrapped obstacles give at least two thirds of the support, hybrid if they give more than a
  /// third, otherwise squeezed if there is a gap.
  ClogMechanism mechanism() const;
};

/// The mechanism and its geometry.
struct Hold {
  ClogMechanism mechanism = ClogMechanism::none;
  ClogGeometry geometry;  ///< of a polygon
};

}  // namespace clog

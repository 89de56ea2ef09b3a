#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "clog/core/parameters/circles.hpp"
#include "clog/core/tools/words.hpp"

namespace clog {

/// The mechanism that holds a clogged droplet: the droplet hangs over obstacles, it cannot pass gaps, or
/// both.
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
  /// Fraction of the support that wrapped obstacles give; NaN without support. The support is the force of
  /// the obstacles on the droplet against the flow.
  double wrapped_support = std::numeric_limits<double>::quiet_NaN();
  std::int64_t num_wrapped = 0;  ///< touched obstacles that the droplet hangs over
  /// Number of gaps in front of the droplet. Two successive arcs (see num_arcs) on different obstacles have a
  /// gap between them under two conditions: the chord from arc to arc faces downstream, and at least one of
  /// the two obstacles supports the droplet.
  std::int64_t num_gaps = 0;
  std::int64_t num_arcs =
      0;  ///< number of arcs; an arc is a chain of edges that touch one obstacle (post or wall)
  /// Largest part of the weight that the corners of the polygon can hold. Each wrapped obstacle contributes
  /// its part of the support times x^2/16. Here x is the length of the longest edge on the obstacle divided
  /// by the distance of this edge from the obstacle's centre. NaN without support.
  double mesh_hold = std::numeric_limits<double>::quiet_NaN();
  /// Circles of the wrapped obstacles that give at least a tenth of the support, in the droplet's
  /// coordinates.
  std::vector<Obstacle> carriers{};

  /// `wrapped` if wrapped obstacles give at least two thirds of the support, `hybrid` if they give more than
  /// a third, otherwise `squeezed` if there is a gap, and `none` if there is no gap.
  ClogMechanism mechanism() const;
};

/// The mechanism that holds a droplet, and the geometry from which it follows.
struct Hold {
  std::optional<ClogMechanism> mechanism = ClogMechanism::none;
  ClogGeometry geometry;  ///< geometry of a polygon; unset for a soft disk
  /// See WallFriction::use(); only carriers count. NaN without carriers or friction.
  double friction_use = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace clog

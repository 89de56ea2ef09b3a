#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// What holds a clogged droplet: obstacles that it hangs over, gaps that it does not get through, or both.
enum class ClogMechanism { none, wrapped, squeezed, hybrid };
template <>
struct Words<ClogMechanism> {
  static constexpr Worded<ClogMechanism> all[] = {{ClogMechanism::none, "none"},
                                                  {ClogMechanism::wrapped, "wrapped"},
                                                  {ClogMechanism::squeezed, "squeezed"},
                                                  {ClogMechanism::hybrid, "hybrid"}};
};

/// How a polygon at rest lies among obstacles; core/README.md has the definitions. The flow is along +x.
struct ClogGeometry {
  /// Of all the obstacles' support against the flow, the part that comes from wrapped ones; NaN without any.
  double wrapped_support = std::numeric_limits<double>::quiet_NaN();
  int num_wrapped = 0;  ///< touched obstacles that the droplet hangs over
  int num_gaps =
      0;  ///< pairs of obstacles, one at least supporting, between which the interface looks downstream
  int num_arcs = 0;  ///< runs of successive edges in contact with one obstacle

  /// Hybrid when wrapped obstacles and others each give a third of the support.
  ClogMechanism mechanism() const;
};

/// @param position       counter-clockwise polygon, all x then all y [sigma]
/// @param obstacles      all that may touch it, periodic images included, in the same coordinates
/// @param contact_range  distance from an obstacle's surface at which contact begins [sigma]
ClogGeometry clog_geometry(const Eigen::ArrayXd& position, std::span<const Obstacle> obstacles,
                           double contact_range);
/// Of a droplet in a periodic array: of the interface that walls meet.
/// @param dp  resolved
ClogGeometry clog_geometry(const DropletState& state, const ObstacleArray& array, const DpParameters& dp);

}  // namespace clog

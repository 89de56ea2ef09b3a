#pragma once

#include <string>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// A local maximum of clearance() outside of all posts, found by a climb from the centre of the period
/// [sigma]. @throws Error if every void is within a post
Eigen::Array2d nearest_void(const ObstacleArray& obstacles);

/// Distance from a point of the first period to the nearest surface of an obstacle or a wedge, at most
/// `limit` [sigma].
double clearance(const ObstacleArray& obstacles, double x, double y, double limit);

/// A droplet at rest.
/// @param droplet  the droplet's points relative to its centre: all x, then all y [sigma]
/// @param place    position of the centre [sigma]
/// @param period   along and across the flow [sigma]
DropletState state_at_rest(const Eigen::ArrayXd& droplet, const Eigen::Array2d& place,
                           const Eigen::Array2d& period);

/// Number of obstacles with a centre inside the polygon.
int num_enclosed(const DropletState& state, const ObstacleArray& obstacles);

/// @throws Error that names the reason and the remedy
[[noreturn]] void refuse_release(const std::string& reason, const std::string& remedy);

/// A droplet may be released if no component of the force on a vertex (DP) or on the disk (SP) exceeds this
/// fraction of the weight of the vertex or disk. The force excludes the weight and the springs.
inline constexpr double release_force_tolerance = 1e-4;
/// This tolerance replaces release_force_tolerance for an interface with springs along it. The force of these
/// springs derives from no energy. This force keeps the interface sliding for ever in a cycle of 1e-3 sigma,
/// while the droplet as a whole stays in place. No observed force exceeded 0.01 of the weight.
inline constexpr double release_sliding_tolerance = 0.02;

}  // namespace clog

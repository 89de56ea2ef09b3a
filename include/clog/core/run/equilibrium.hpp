#pragma once

#include <optional>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// How far any coordinate of a vertex, or of the soft disk, may be from its place at rest [sigma].
inline constexpr double farthest_rest = 0.03;
/// Smallest stiffness that an equilibrium must have against any displacement [M g/sigma]: the force that
/// pulls a droplet back, over the way it has been displaced as a whole.
inline constexpr double least_stiffness = 1e-3;

/// The stable static equilibrium next to a droplet that has nearly stopped, where it is about to come to
/// rest; nothing if there is none, or none that is certain to be the one that the droplet would reach.
///
/// Newton's method on the forces, until nothing is left of them but round-off. Every shape on the way must
/// lie where the potential energy is convex, and none may be farther than `farthest_rest` from the present
/// one: then both lie in one basin. A droplet that balances on an obstacle, that could drift aside freely, or
/// that creeps past a place where there is no equilibrium is refused.
///
/// With springs along the interface, how far the interface has slid around itself has no part in this: see
/// equilibrium.cpp.
/// @param run    resolved parameters
/// @param state  of the droplet; its velocities do not count
std::optional<DropletState> find_equilibrium(const RunParameters& run, const ObstacleArray& obstacles,
                                             const DropletState& state);

}  // namespace clog

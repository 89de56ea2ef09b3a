#pragma once

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// A droplet at rest, without weight, near the centre of the box: the start of a run.
///
/// DP: a small circle is put into the void nearest to the centre and grown to full size, relaxing as it
/// grows, so that no obstacle is ever inside (energy minimisation cannot see an obstacle that touches no
/// vertex). SP: starts at the same void and relaxes.
/// @param run  resolved parameters
/// @throws Error if there is no room for a droplet near the centre, or it does not relax
DropletState release_droplet(const RunParameters& run, const ObstacleArray& obstacles);

/// The droplet without walls and weight, around the origin: the regular polygon in which area pressure
/// balances line tension and springs, a little smaller than a_0 (for sp, the point).
Eigen::ArrayXd free_droplet(const RunParameters& run);

/// Distance from a free droplet's centre at which a wall begins to push it [sigma].
double reach(const RunParameters& run, const Eigen::ArrayXd& droplet);

/// Distance from a point of the box to the nearest obstacle surface, at most `limit` [sigma].
double clearance(const ObstacleArray& obstacles, double x, double y, double limit);

/// Number of obstacles whose centre lies inside the polygon.
int num_enclosed(const DropletState& state, const ObstacleArray& obstacles);

/// Largest force component, without weight and springs, that a droplet may be released with: relative to the
/// weight of one vertex (DP), to its own weight (SP).
inline constexpr double release_force_tolerance = 1e-4;
/// The same for an interface that springs along it, which have no energy, keep sliding for ever: it goes
/// round a cycle of 1e-3 sigma, and no force has been seen to exceed 0.01; the droplet as a whole stays where
/// it is.
inline constexpr double release_sliding_tolerance = 0.02;

}  // namespace clog

#pragma once

#include <cstdint>
#include <optional>

#include "clog/core/parameters/parameters.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// A square lattice with the vectors a (cos t, sin t) and a (-sin t, cos t) that has a square box as a
/// period. It does if the box's edge joins two of its points, L (1, 0) = p first - q second with integers p,
/// q: L = a sqrt(p^2 + q^2), tan t = q/p.
struct CommensurateLattice {
  int p = 1;
  int q = 0;
  double box = 0;    ///< L [sigma]
  double angle = 0;  ///< t [degrees]
};

/// How far the tilt of a lattice may be from the one asked for [degrees].
inline constexpr double largest_angle_error = 0.1;

/// The lattice nearest to the angle whose box has `smallest_box` <= L <= `largest_box`; of several as near,
/// the one with the largest box. Empty if no lattice has such a box.
/// @param spacing  a [sigma]
/// @param angle  -45..45 [degrees]; by symmetry there are no others
std::optional<CommensurateLattice> nearest_lattice(double spacing, double angle, double smallest_box,
                                                   double largest_box);

/// The same for the spacing, the angle and the box of an array, whose period is at least two spacings.
std::optional<CommensurateLattice> nearest_lattice(const ObstacleParameters& obstacles);
/// The nearest one of spacing diameter + gap whose box is no larger than `box`; empty if its tilt is too far
/// from lattice_angle.
std::optional<CommensurateLattice> fitting_lattice(const ObstacleParameters& obstacles);
/// The smallest whole-numbered box for which there is one [sigma].
double box_that_fits(const ObstacleParameters& obstacles);

/// Square lattice of spacing diameter + gap, tilted by lattice_angle. The seed shifts it: the box's centre,
/// where droplets are released, is uniform in a unit cell among the places where a droplet touches no
/// obstacle; among all places if there is none.
/// @param parameters  resolved: box and angle are those of a CommensurateLattice
ObstacleArray lattice_obstacles(const ObstacleParameters& parameters, std::uint32_t seed);

}  // namespace clog

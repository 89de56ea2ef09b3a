#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "clog/core/parameters/parameters.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// A lattice with a rectangular period along the flow. A lattice has such a period if its tilt t is rational:
/// tan t = q/p with integers p and q, or tan t = sqrt(3) q/p for a triangular lattice. For the square lattice
/// with the vectors v1 and v2, the vector p v1 - q v2 then points along the flow, and the period is as long
/// as this vector: sqrt(p^2 + q^2) spacings.
struct CommensurateLattice {
  int p = 1;
  int q = 0;
  double box = 0;     ///< period across the flow [sigma]
  double length = 0;  ///< period along the flow; 0: equal to box [sigma]
  double angle = 0;   ///< t [degrees]
};

/// Largest deviation of a lattice's tilt from the requested tilt [degrees].
inline constexpr double largest_angle_error = 0.1;
/// Largest allowed tilt [degrees]. For square and triangular lattices, every larger tilt gives the same
/// lattice as some smaller tilt.
double largest_tilt(LatticeKind kind);

/// The lattice with the tilt nearest to lattice_angle. Its periods are at most `box` and `length` (0: `box`),
/// and at least two spacings and `narrowest_period`. If several lattices are equally near, the one with the
/// largest box is chosen. nullopt if no lattice has such periods.
std::optional<CommensurateLattice> nearest_lattice(const ObstacleParameters& obstacles);
/// nearest_lattice(); nullopt if its tilt is more than largest_angle_error away from lattice_angle.
std::optional<CommensurateLattice> fitting_lattice(const ObstacleParameters& obstacles);
/// A whole-numbered width of the box, larger than the given width, for which there is a fitting_lattice()
/// [sigma].
double box_that_fits(const ObstacleParameters& obstacles);
/// The nearest lattices on both sides of lattice_angle, if there are any.
std::vector<CommensurateLattice> neighbouring_lattices(const ObstacleParameters& obstacles);

/// Replaces a given pitch by the corresponding gap. @throws Error if the pitch is not larger than the
/// diameter
void use_pitch(ObstacleParameters& obstacles);
/// Obstacles per area [1/sigma^2].
double lattice_density(const ObstacleParameters& obstacles);
/// Distance between two neighbouring rows, which are tilted by lattice_angle [sigma].
double row_spacing(const ObstacleParameters& obstacles);
/// The tilt of a lattice in words, e.g. "14.04 degrees (tan = 1/4)".
std::string tilt_text(LatticeKind kind, const CommensurateLattice& lattice);
/// Pitch, row spacing, tilt and period, in words. @param obstacles  resolved
std::string lattice_text(const ObstacleParameters& obstacles);

/// A lattice of spacing diameter + gap, shifted according to the seed. The shift moves the box's centre,
/// where droplets are released, to a uniformly distributed place of the unit cell. Places where a droplet
/// touches an obstacle are excluded, unless there are no other places.
/// @param parameters  resolved: box, length and angle are those of a CommensurateLattice
ObstacleArray lattice_obstacles(const ObstacleParameters& parameters, std::uint32_t seed);

}  // namespace clog

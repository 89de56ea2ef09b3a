#pragma once

#include <cmath>
#include <numbers>

#include "clog/core/tools/portable_math.hpp"

/// Reduced units: droplet diameter sigma = 1, gravity g = 1, areal density rho = 1.
/// Time is then in t0 = sqrt(sigma/g), speed in sqrt(sigma g), force in g rho sigma^2, energy in g rho
/// sigma^3. Gravity points along +x, the flow direction.
namespace clog::units {

inline constexpr double droplet_diameter = 1.0;
inline constexpr double gravity = 1.0;
inline constexpr double rest_area = std::numbers::pi / 4;
inline constexpr double droplet_mass = rest_area;

/// Edge length of the regular polygon with this area [sigma]:
/// l0 = sqrt(4 a N tan(pi/N)) / N, Cheng et al., on how a simulation begins.
inline double regular_edge_length(int num_vertices, double area = rest_area) {
  return std::sqrt(4 * area * num_vertices * portable::tan(std::numbers::pi / num_vertices)) / num_vertices;
}

}  // namespace clog::units

#pragma once

#include "clog/core/parameters/parameters.hpp"

namespace clog {

/// Upper bounds on omega^2 [1/t0^2] of the stiff modes of a polygon with the given perimeter [sigma]. The
/// bounds hold for a chain of masses M/N_v. Velocity Verlet is stable for omega dt < 2.
struct StiffModes {
  /// One vertex in contact with a wall (with both its edges if walls push edges): 2 k_c N_v/M.
  double contact = 0;
  /// Contact of two strands, in which each vertex is between two edges and each edge between two vertices: 8
  /// k_c N_v/M.
  double self_contact = 0;
  double area = 0;     ///< uniform pressure, K_a P^2/M
  double tension = 0;  ///< transverse zigzag, 4 Gamma N_v/(l M), l the shortest edge
  double spring = 0;   ///< longitudinal zigzag, 4 K_l N_v^2/M
  /// Attraction or repulsion by a wall where the tension changes, 6 |Gamma_wall - Gamma| l N_v/(w^2 M)
  double wetting = 0;
  double pinning = 0;   ///< spring that holds the end of a wetted arc
  double friction = 0;  ///< springs by which walls hold a vertex along them, k_t N_v/M

  /// Sum of the modes of a droplet that does not touch itself.
  double sum() const { return contact + area + tension + spring + wetting + pinning + friction; }
};

/// (omega dt)^2 of the contact mode for the automatic E_w. With this value, overlaps are about 1e-2 vertex
/// diameters for Gamma <= 1, and droplets come to rest without chatter. (The bound of 4 for a linear spring
/// is much too large, because contact pushes but never pulls.)
inline constexpr double auto_contact_omega_dt2 = 0.5;
/// Largest accepted (omega dt)^2 of the contact alone and of all modes together. With larger values, stopped
/// droplets chattered instead of coming to rest.
inline constexpr double max_contact_omega_dt2 = 1.0;
inline constexpr double max_total_omega_dt2 = 3.0;
/// Largest accepted (omega dt)^2 of all modes together for a droplet in contact with itself. This bound is
/// larger than max_total_omega_dt2, because self-contact is rare and softer than StiffModes::self_contact
/// assumes.
inline constexpr double max_total_with_self_omega_dt2 = 3.9;
/// The area mode is anharmonic in the perimeter, so it has a separate bound. With a bound of 1.25, three
/// times as many droplets without drag diverged (docs/notes/2026-11-26-time-step.md).
inline constexpr double max_area_omega_dt2 = 1.0;

/// With the automatic step, the modes of a circle reach at most this fraction of their bounds.
inline constexpr double auto_step_margin = 0.8;

/// Stiff modes of a polygon with resolved parameters (see resolve()), for the given perimeter and shortest
/// edge [sigma]. A shortest edge below a hundredth of the mean edge counts as a hundredth of the mean edge.
StiffModes stiff_modes(const DpParameters& dp, double wall_stiffness, double perimeter, double shortest_edge);

/// Largest time step [t0] with which the modes stay within all bounds above.
double largest_stable_step(const StiffModes& modes);
/// Largest time step [t0] if the pressure is implicit (see Pressure).
double largest_step_with_implicit_pressure(const StiffModes& modes);

/// A droplet that needs more sub-steps than this for one time step has burst; the run ends at its next check.
inline constexpr int most_substeps = 1000;

enum class Pressure {
  present,  ///< the pressure of the present area
  /// The pressure of the area that the droplet would have if its present acceleration lasted for a step
  /// (docs/explanation/numerics.md). With this pressure, (omega dt)^2 of the area mode is below 1 for every
  /// step.
  implicit
};
/// Steps of equal length [t0].
struct Steps {
  int num;
  double length;
  Pressure pressure = Pressure::present;
};
/// The smallest number of equal steps that cover `steps` time steps and stay within all bounds. It is at
/// least `steps`, and at most most_substeps times as large. Up to 2 `steps` the number is exact. A larger
/// number is rounded up to a multiple of `steps`, because shapes that need so many steps are far from the
/// regular polygons for which the bounds hold.
/// @param most  Pressure::implicit: the pressure may be implicit if this saves steps
Steps stable_steps(const StiffModes& modes, int steps, double time_step, Pressure most);

}  // namespace clog

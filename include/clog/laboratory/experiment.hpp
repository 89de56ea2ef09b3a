#pragma once

#include <string>

namespace clog::laboratory {

/// Converts a number with its unit, e.g. "3.5 mm" or "7mm/s", to SI units.
/// @param units  the measured quantity: "length", "number per area", "time", "speed", "tension", "density" or
/// "angle" (in radians)
/// @throws Error that names the possible units
double to_si(const std::string& text, const std::string& units);
/// The inverse of to_si(): twelve digits and the usual unit, e.g. "3.5 mm".
std::string in_usual_unit(double value, const std::string& units);

/// A droplet between two plates that are tilted, driven by buoyancy; all in SI units.
struct Experiment {
  double diameter = 0;        ///< diameter of the undeformed droplet [m]
  double terminal_speed = 0;  ///< speed far from walls [m/s]
  double tilt = 0;            ///< tilt of the plates to the horizontal [rad]
  double droplet_density = 0;
  double outer_density = 0;
  double interfacial_tension = 0;  ///< NaN if it is not known [N/m]

  /// g_exp = sin(tilt) g |rho_outer - rho_droplet|/rho_droplet, acceleration by weight and buoyancy [m/s^2]
  double gravity() const;
  /// V_t = v_t/sqrt(sigma g_exp)
  double reduced_terminal_speed() const;
  /// Gamma_exp = gamma/(g_exp rho_droplet sigma^2) (Cheng et al., Eq. 7)
  double line_tension() const;
};

}  // namespace clog::laboratory

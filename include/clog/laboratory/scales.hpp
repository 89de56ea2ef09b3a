#pragma once

#include "clog/laboratory/lab_file.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::laboratory {

/// What the model's units are in a laboratory, and its numbers for a droplet there. NaN where the laboratory
/// does not say enough.
struct Scales {
  double length = 0;   ///< sigma [m]
  double gravity = 0;  ///< g_exp [m/s^2]
  double time = 0;     ///< t0 = sqrt(sigma/g_exp) [s]
  double speed = 0;    ///< v_t [m/s]
  double tension = 0;  ///< of Gamma = 1: interfacial tension of the droplet that moves so [N/m]
  double line_tension_experiment = 0;  ///< Gamma_exp
  double line_tension = 0;             ///< Gamma of the model, tension_ratio times Gamma_exp
  double sag = 0;                      ///< of that droplet on a flat wall [sigma]
  double wall_stiffness = 0;           ///< E_w of the soft disk that sags as far
  double terminal_speed = 0;           ///< V_t
  double capillary_number = 0;         ///< Ca = pi/(4 Gamma), at the terminal speed
  double line_tension_of_cell = 0;     ///< interfacial tension times thickness [N]
};
Scales scales_of(const Laboratory& lab);
/// Gives terminal speed and line tension (of soft disks wall stiffness) the values of the laboratory's
/// droplet, unless the user has set them.
void set_droplet(const Laboratory& lab, sweep::Settings& settings);

/// How far the centroid of a droplet sinks that its weight presses on a flat wall, which it does not wet: the
/// two-dimensional equation of Young and Laplace [sigma]. NaN for Gamma below 1e-3 and above 1e4.
double sag_on_wall(double line_tension);
/// Gamma of the droplet that sags so far; NaN if none does.
double line_tension_of_sag(double sag);
/// E_w = pi/(16 sag), of the soft disk that sags as far.
double wall_stiffness_of_sag(double sag);

/// Gamma of the laboratory's droplet between upright plates, the least it can have; NaN without its tension.
double line_tension_upright(const Laboratory& lab);
/// Tilt at which a droplet of the laboratory has this Gamma [rad]; NaN if none does.
double tilt_of(double line_tension, const Laboratory& lab);

}  // namespace clog::laboratory

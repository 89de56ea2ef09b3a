#pragma once

#include <map>
#include <string>

#include "clog/laboratory/lab_file.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::laboratory {

/// The model's units in a laboratory, and the model's numbers for the droplet of the laboratory. Numbers are
/// NaN if the description of the laboratory is incomplete.
struct Scales {
  double length = 0;   ///< the model's sigma, the diameter of the droplet [m]
  double gravity = 0;  ///< acceleration g_exp along the plates [m/s^2]
  double time = 0;     ///< the model's t0 = sqrt(sigma/g_exp) [s]
  double speed = 0;    ///< terminal speed v_t [m/s]
  double tension =
      0;  ///< interfacial tension of a droplet that moves like a simulated droplet with Gamma = 1 [N/m]
  double line_tension_experiment = 0;  ///< Gamma_exp, from the measured tension
  double line_tension = 0;             ///< Gamma of the model, tension_ratio times Gamma_exp
  double sag = 0;                      ///< sag of a droplet of this line tension on a flat wall [sigma]
  double wall_stiffness = 0;           ///< E_w of the soft disk with this sag
  double terminal_speed = 0;           ///< V_t, the terminal speed in the model's units
  double capillary_number = 0;         ///< Ca = pi/(4 Gamma), at the terminal speed
  double line_tension_of_cell = 0;     ///< interfacial tension times thickness [N]
  double break_up_neck = 0;  ///< width of a neck that breaks; it equals the thickness of the cell [sigma]
};
Scales scales_of(const Laboratory& lab);

/// Text of the Gamma that droplet_texts() gives to runs; empty if Gamma is unknown.
std::string line_tension_text(const Scales& scales);
/// The text of each key, by the key's name.
using Texts = std::map<std::string, std::string>;
/// The laboratory's description, and properties of its droplet: the terminal speed, the line tension or, for
/// soft disks, the wall stiffness, and the exponent of the speeds of daughters. A property that the user has
/// set is not included.
/// @param model  empty for keys of all models
/// @param has_daughters  whether the run follows daughters
Texts droplet_texts(const Laboratory& lab, const sweep::Settings& settings, const std::string& model,
                    bool has_daughters);
/// A key's text with its numbers in the model's units: `0.2mm,0.3mm` is `0.1,0.15` with a droplet of 2 mm.
/// @param text  numbers without a unit, and those in sigma, keep their values
/// @throws Error that names the key, if one of its numbers has a unit that does not suit the key
std::string in_model_units(const std::string& key, const std::string& text, const Scales& scales);
/// The inverse for one value, with four digits: "0.4 mm". Empty if numbers of the key have no unit.
std::string in_laboratory_units(const std::string& key, double value, const Scales& scales);
/// Converts the lengths of a list to droplet diameters. @param diameter  diameter of the droplet; NaN:
/// unknown [m]
/// @throws Error whose text does not name the list
std::string in_diameters(const std::string& text, double diameter);

/// The sag: the distance by which the centroid of a droplet sinks on a flat wall that it does not wet
/// [sigma]. It follows from the two-dimensional Young-Laplace equation. NaN for Gamma below 1e-3 and above
/// 1e4.
double sag_on_wall(double line_tension);
/// Gamma of the droplet with this sag; NaN if there is none.
double line_tension_of_sag(double sag);
/// E_w = pi/(16 sag) of the soft disk with this sag.
double wall_stiffness_of_sag(double sag);

/// Gamma of the laboratory's droplet between upright plates. In this position gravity along the plates is
/// strongest, so Gamma is smallest. NaN if the interfacial tension is unknown.
double line_tension_upright(const Laboratory& lab);
/// Tilt at which a droplet of the laboratory has this Gamma [rad]; NaN if none does.
double tilt_of(double line_tension, const Laboratory& lab);

}  // namespace clog::laboratory

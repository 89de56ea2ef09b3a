#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "clog/laboratory/experiment.hpp"

namespace clog::laboratory {

/// A terminal speed that was measured with another droplet or at another tilt. The speed is proportional to
/// diameter^exponent. It is also proportional to sin(tilt), because the drag of the model is linear. The
/// exponent is 0 by default, because weight and drag of a flat droplet between two plates are both
/// proportional to the droplet's area (Taylor and Saffman 1959).
struct MeasuredSpeed {
  double speed = 0, diameter = 0, tilt = 0;  ///< [m/s], [m], [rad]
  double exponent = 0;
};

/// The experiment that a file lab.cfg describes.
struct Laboratory {
  Experiment experiment;  ///< if not known, terminal_speed is 0 and interfacial_tension NaN
  double thickness = std::numeric_limits<double>::quiet_NaN();  ///< thickness of the cell [m]
  /// Gamma of the model divided by Gamma_exp. The default fits the three droplets of Cheng et al. These
  /// authors write that the difference between the two Gammas "likely stems from the fact that we compare
  /// values of the dimensionless line tension in 2D to values of the dimensionless surface tension in 3D".
  double tension_ratio = 0.3;
  bool has_own_ratio = false;                  ///< whether the file gives tension_ratio
  std::optional<MeasuredSpeed> measured = {};  ///< the speed that was scaled to the terminal speed, if any
  std::string text;                            ///< `key = value; key = value`
};

/// Reads lines `key = value`, or several of them separated by semicolons; `#` begins a comment. Returns one
/// laboratory for each combination of the diameters and the angles that the file lists; angles vary fastest.
/// @throws Error naming file and key
std::vector<Laboratory> read_laboratories(const std::string& path);
constexpr const char* give_one_droplet = "give one diameter and one angle";
/// Reads a file that describes one laboratory. @throws Error as read_laboratories(), and if the file
/// describes several laboratories
/// @param remedy  text of the message that says what to do about several laboratories
Laboratory read_laboratory(const std::string& path, const std::string& remedy = give_one_droplet);
/// A question about the unit if a density is that of a gas; empty otherwise. Bubbles are possible droplets.
std::string unusual_density(const Laboratory& lab);
/// One line on how the terminal speed was scaled; empty if the speed was measured.
std::string law_of_speed(const Laboratory& lab);
/// @param source  name of the text in messages
Laboratory parse_laboratory(const std::string& text, const std::string& source,
                            const std::string& remedy = give_one_droplet);

}  // namespace clog::laboratory

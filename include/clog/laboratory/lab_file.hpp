#pragma once

#include <limits>
#include <string>

#include "clog/laboratory/experiment.hpp"

namespace clog::laboratory {

/// An experiment as a lab.cfg describes it.
struct Laboratory {
  Experiment experiment;  ///< terminal_speed 0, interfacial_tension NaN where they are not known
  double thickness = std::numeric_limits<double>::quiet_NaN();  ///< of the cell [m]
  /// Gamma of the model over Gamma_exp: that of the three droplets of Cheng et al. "likely stems from the
  /// fact that we compare values of the dimensionless line tension in 2D to values of the dimensionless
  /// surface tension in 3D".
  double tension_ratio = 0.3;
  std::string text;  ///< `key = value; key = value`
};

/// Lines, or parts between semicolons, `key = value`; `#` begins a comment. @throws Error naming file and key
Laboratory read_laboratory(const std::string& path);
/// @param source  what the text is called in messages
Laboratory parse_laboratory(const std::string& text, const std::string& source);

}  // namespace clog::laboratory

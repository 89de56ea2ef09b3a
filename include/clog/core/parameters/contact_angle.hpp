#pragma once

#include <cmath>
#include <numbers>

#include "clog/core/parameters/parameters.hpp"
#include "clog/core/tools/portable_math.hpp"

namespace clog {

/// Tension of the interface on a wall divided by Gamma. If the user does not give the tension, it is minus
/// the mean cosine of the receding and the advancing angle. This mean assumes that the wall resists both
/// motions equally. Without contact angles, the tension is 1.
inline double wall_tension(const DpParameters& dp) {
  if (dp.wall_tension) return *dp.wall_tension;
  if (!dp.receding_angle || !dp.advancing_angle) return 1;
  const auto cosine = [](double degrees) { return portable::cos(degrees * std::numbers::pi / 180); };
  return -(cosine(*dp.receding_angle) + cosine(*dp.advancing_angle)) / 2;
}

/// Young's contact angle of the droplet's fluid [degrees]; wall-tension is minus the cosine of this angle.
inline double young_angle(const DpParameters& dp) {
  const double tension = wall_tension(dp);
  return portable::atan2(std::sqrt(1 - tension * tension), -tension) * 180 / std::numbers::pi;
}

}  // namespace clog

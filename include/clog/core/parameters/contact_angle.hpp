#pragma once

#include <cmath>
#include <numbers>

#include "clog/core/parameters/parameters.hpp"
#include "clog/core/tools/portable_math.hpp"

namespace clog {

/// Young's contact angle of the droplet's fluid, of which wall-tension is minus the cosine [degrees].
inline double young_angle(const DpParameters& dp) {
  const double sine = std::sqrt(1 - dp.wall_tension * dp.wall_tension);
  return portable::atan2(sine, -dp.wall_tension) * 180 / std::numbers::pi;
}

}  // namespace clog

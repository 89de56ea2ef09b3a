#pragma once

#include <span>

namespace clog::fit {

/// Speed of a droplet that moves along a wall.
struct NearWallSpeed {
  double distance;  ///< d, between wall and droplet surface [sigma]
  double speed;     ///< v_g, far from walls 1 [v_t]
};

/// v_g/(v_t - v_g) = (b_inf/b_0) (d/sigma)^alpha (Cheng et al., Appendix A).
struct NearWallDrag {
  double exponent = 0;        ///< alpha
  double exponent_error = 0;  ///< standard error; NaN for two points
  double drag = 0;            ///< b_0/b_inf
  double drag_error = 0;      ///< standard error; NaN for two points
};

/// Straight line through log(v_g/(v_t - v_g)) against log d by least squares; errors are from the scatter
/// about it.
/// @throws std::invalid_argument for fewer than two different distances, a distance that is not positive, or
/// a speed outside 0..1
NearWallDrag fit_near_wall_drag(std::span<const NearWallSpeed> speeds);

}  // namespace clog::fit

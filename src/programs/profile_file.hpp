#pragma once

#include <string>
#include <vector>

#include "clog/fit/calibration.hpp"
#include "clog/fit/near_wall_drag.hpp"

namespace clog {

/// Lengths and speeds that profiles in laboratory units are divided by [m, m/s]; 0 if they are not known.
struct ProfileScales {
  double diameter = 0;
  double terminal_speed = 0;
};

/// Reads a droplet's way through a channel from a CSV file: one line per frame, a header that names columns
/// and units, e.g. `h [mm], v [mm/s], A` or `h [sigma], v [v_t], A`. h and v are needed, other columns than A
/// are passed over. Lines starting with # are comments. Empty cells of A are frames without a shape.
/// @throws Error naming file and line
fit::Profile read_profile(const std::string& path, const ProfileScales& scales);

/// Reads speeds along a wall in the same way: columns d and v, e.g. `d [mm], v [mm/s]` or `d [sigma], v
/// [v_t]`.
/// @throws Error naming file and line
std::vector<fit::NearWallSpeed> read_near_wall_speeds(const std::string& path, const ProfileScales& scales);

}  // namespace clog

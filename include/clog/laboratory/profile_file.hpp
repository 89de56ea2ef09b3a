#pragma once

#include <string>
#include <vector>

#include "clog/fit/calibration.hpp"
#include "clog/fit/near_wall_drag.hpp"
#include "clog/store/run_table.hpp"

namespace clog::laboratory {

/// Lengths and speeds that profiles in laboratory units are divided by [m, m/s]; 0 if they are not known.
struct ProfileScales {
  double diameter = 0;
  double terminal_speed = 0;
};

/// Reads a droplet's way through a channel from a CSV file: one line per frame, a header that names columns
/// and units, e.g. `h [mm], v [mm/s], A` or `h [sigma], v [v_t], A`. h and v are needed, other columns than A
/// are passed over. Lines starting with # are comments. Empty cells of A are frames without a shape. Of an
/// HDF5 file written by `clogrun channel`, every sample.
/// @throws Error naming file and line
fit::Profile read_profile(const std::string& path, const ProfileScales& scales);

/// What a droplet's way through a channel is to be compared with.
struct MeasuredProfile {
  fit::Profile frames;
  store::Provenance origin;  ///< of a simulated one, as it was stored; empty for CSV files
};
/// As read_profile(); of an HDF5 file frames like a camera's, every 0.05 sigma within 1.5 sigma of the
/// orifice.
/// @throws Error
MeasuredProfile read_measured_profile(const std::string& path, const ProfileScales& scales);

/// Reads speeds along a wall in the same way: columns d and v, e.g. `d [mm], v [mm/s]` or `d [sigma], v
/// [v_t]`.
/// @throws Error naming file and line
std::vector<fit::NearWallSpeed> read_near_wall_speeds(const std::string& path, const ProfileScales& scales);

}  // namespace clog::laboratory

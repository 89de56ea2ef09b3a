#pragma once

#include <Eigen/Core>
#include <limits>

#include "clog/core/parameters/parameters.hpp"

namespace clog {

/// Size of the box of channels and walls, which have no periodic images. The box only limits coordinates
/// [sigma].
inline constexpr double open_box = 256;
inline Eigen::Array2d middle_of_open_box() { return {open_box / 2, open_box / 2}; }
inline Eigen::Array2d period_of_open_box() { return {open_box, open_box}; }

/// The density is unknown, because there are no circles to count.
inline double no_density(const ObstacleParameters&) { return std::numeric_limits<double>::quiet_NaN(); }

}  // namespace clog

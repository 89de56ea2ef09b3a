#pragma once

#include <span>
#include <string>
#include <vector>

#include "clog/core/world/obstacle_array.hpp"

namespace clog::cli {

/// How the lines of an obstacle file are to be understood.
struct ObstacleFileRules {
  Period period;            ///< in which all centres must lie
  double default_diameter;  ///< for lines without one [sigma]
  double narrowest_gap;     ///< gaps between surfaces must be wider [sigma]
};

/// Reads circles from a CSV file: x,y[,diameter] per line [sigma]; a first line x,y,... and lines starting
/// with # are skipped.
/// @throws Error naming the line, or the two lines whose circles touch, overlap or leave too narrow a gap
ObstacleArray read_obstacles(const std::string& path, const ObstacleFileRules& rules);

/// Writes them in the same form, with digits that read back exactly. @throws Error
void write_obstacles(const std::string& path, std::span<const Obstacle> obstacles);

}  // namespace clog::cli

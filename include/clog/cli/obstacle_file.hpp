#pragma once

#include <string>
#include <vector>

#include "clog/core/obstacle_array.hpp"

namespace clog::cli {

/// Reads circles from a CSV file: x,y[,diameter] per line [sigma]; a first line x,y,... and lines starting
/// with # are skipped.
/// @param default_diameter  for lines without one
/// @param box               centres must lie in [0, box)
/// @throws Error naming the line
std::vector<Obstacle> read_obstacles(const std::string& path, double default_diameter, double box);

/// Writes them in the same form, with digits that read back exactly. @throws Error
void write_obstacles(const std::string& path, const std::vector<Obstacle>& obstacles);

}  // namespace clog::cli

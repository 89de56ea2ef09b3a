#pragma once

#include <span>
#include <string>
#include <vector>

#include "clog/core/parameters/circles.hpp"

namespace clog::cli {

/// Reads circles from a CSV file: x,y[,diameter] per line [sigma]; a first line x,y,... and lines starting
/// with # are skipped. A line without a diameter means obstacle-diameter.
/// @throws Error naming the line
OwnCircles read_circles(const std::string& path);

/// Writes them in the same form, with digits that read back exactly. @throws Error
void write_obstacles(const std::string& path, std::span<const Obstacle> obstacles);

}  // namespace clog::cli

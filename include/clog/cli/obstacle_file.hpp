#pragma once

#include <span>
#include <string>
#include <vector>

#include "clog/core/parameters/circles.hpp"

namespace clog::cli {

/// Reads circles from a text file, one a line: x, y and the diameter [sigma], or as the names in the first
/// line say; cells are separated by commas, semicolons, tabs or blanks. A line without a diameter means
/// obstacle-diameter. Lines starting with # are skipped, but for `# units=um droplet=200um`, which says in
/// which units the following lengths are; then no diameter may be missing.
/// @param name  of the file, with @0.8mm behind it if the circles are to be scaled to a droplet of 0.8 mm
/// @throws Error naming the line
OwnCircles read_circles(const std::string& name);

/// Writes them in the same form, with digits that read back exactly. @throws Error
void write_obstacles(const std::string& path, std::span<const Obstacle> obstacles);

}  // namespace clog::cli

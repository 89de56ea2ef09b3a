#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "clog/core/parameters/circles.hpp"

namespace clog::cli {

/// Reads circles from a text file with one circle per line. The columns are x, y and the diameter [sigma],
/// unless the first line names the columns. Commas, semicolons, tabs or blanks separate the cells. A circle
/// without a diameter gets obstacle-diameter. Lines starting with # are skipped. The exception is a comment
/// such as `# units=um droplet=200um`: it gives the unit of all further lengths and the diameter of the
/// droplet. In a file with this comment, every circle needs a diameter.
/// @param name  name of the file, followed by @0.8mm to scale the circles to a droplet of 0.8 mm. The file
/// then needs only a unit, in a comment or in the names of its columns, and circles may lack a diameter: the
/// caller checks that obstacle-diameter has a unit
/// @param laboratory_droplet  diameter of the laboratory's droplet, for files that state none, as @0.8mm [m]
/// @throws Error naming the line
OwnCircles read_circles(const std::string& name, const std::optional<double>& laboratory_droplet = {});

/// Writes circles in the form that read_circles() reads, with enough digits to read them back exactly.
/// @throws Error
void write_obstacles(const std::string& path, std::span<const Obstacle> obstacles);

}  // namespace clog::cli

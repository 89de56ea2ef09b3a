#pragma once

#include "clog/core/parameters/parameters.hpp"

namespace clog {

/// What both arrays that follow from a gap and a diameter have in common. @throws Error
void check_spacing(const RunParameters& run);

/// The interface bends around obstacles.
double smallest_diameter(const RunParameters& run);

/// A droplet never comes to the end of a periodic array, nor through a wall.
double endless_way(const RunParameters& run);

}  // namespace clog

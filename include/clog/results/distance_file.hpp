#pragma once

#include <string>
#include <vector>

#include "clog/results/distance_table.hpp"

namespace clog::results {

/// Whether this is the name of a text table of distances rather than of a sweep's file.
bool is_distance_table(const std::string& path);
/// Reads a table with the columns `distance [UNIT]` and `clogged` (1 or 0, yes or no, true or false). Rows
/// with equal values in all other columns form a group. The columns `diameter [UNIT]` and `angle [deg]`
/// become the labels `diameter` [mm] and `angle` [degrees]. Prints a hint if every droplet forms a separate
/// group.
/// @param taken  names of results; no other column may have such a name, in any case and with any unit
/// @throws Error that names file and line
DistanceTable read_distances(const std::string& path, const std::vector<std::string>& taken);

}  // namespace clog::results

#pragma once

#include <string>
#include <vector>

#include "clog/results/distance_table.hpp"

namespace clog::results {

/// Whether this is the name of a text table, not of a sweep's file.
bool is_distance_table(const std::string& path);
/// Reads a table with the columns `distance [UNIT]` and `clogged` (1 or 0, yes or no, true or false). Rows
/// with the same values in all other columns form a group. The columns `diameter [UNIT]` and `angle [deg]`
/// become the labels `diameter` [mm] and `angle` [degrees]. Prints a hint if each droplet is a group of its
/// own.
/// @param taken  names of results, which no other column may have, in any case and with any unit
/// @throws Error that names file and line
DistanceTable read_distances(const std::string& path, const std::vector<std::string>& taken);

}  // namespace clog::results

#pragma once

#include <string>

#include "clog/sweep/points.hpp"

namespace clog::cli {

/// Reads points from a CSV file. The first line names keys, and each further line is a parameter set. For an
/// empty cell, the value comes from the config or the command line. Blank lines and lines that begin with #
/// are ignored. The values are not checked here. Settings::set_points() checks them after the caller has
/// converted numbers with units. @throws Error that names the file, and the line
sweep::Points read_points(const std::string& path);

}  // namespace clog::cli

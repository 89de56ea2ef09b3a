#pragma once

#include <string>

#include "clog/sweep/points.hpp"

namespace clog::cli {

/// Reads points from a CSV file: the first line names keys, each further line is a parameter set. An empty
/// cell stands for the value that the key has in the config or on the command line. Blank lines and those
/// that begin with # are ignored. The values are not checked here: Settings::set_points() does this, after
/// the caller has converted numbers with units. @throws Error that names the file, and the line
sweep::Points read_points(const std::string& path);

}  // namespace clog::cli

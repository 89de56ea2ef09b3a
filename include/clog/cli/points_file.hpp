#pragma once

#include <string>

#include "clog/sweep/points.hpp"

namespace clog::cli {

enum class Units { refused, kept };

/// Reads points from a CSV file: the first line names keys, each further line is a parameter set. An empty
/// cell stands for the value that the key has in the config or on the command line. Blank lines and those
/// that begin with # are ignored.
/// @param units  whether numbers may have units, which the caller converts @throws Error that names the file,
/// and the line
sweep::Points read_points(const std::string& path, Units units);

}  // namespace clog::cli

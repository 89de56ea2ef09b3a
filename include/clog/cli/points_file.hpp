#pragma once

#include <string>

#include "clog/sweep/points.hpp"

namespace clog::cli {

/// Reads points from a CSV file: the first line names keys, each line that follows is a parameter set. An
/// empty cell stands for what the key has without points. Blank lines and those that begin with # say
/// nothing.
/// @throws Error that names the file, and the line
sweep::Points read_points(const std::string& path);

}  // namespace clog::cli

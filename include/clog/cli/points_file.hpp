#pragma once

#include <string>

#include "clog/sweep/points.hpp"

namespace clog::cli {

enum class Units { refused, kept };

/// Reads points from a CSV file: the first line names keys, each line that follows is a parameter set. An
/// empty cell stands for what the key has without points. Blank lines and those that begin with # say
/// nothing.
/// @param units  may numbers have some, which the caller is to convert?
/// @throws Error that names the file, and the line
sweep::Points read_points(const std::string& path, Units units);

}  // namespace clog::cli

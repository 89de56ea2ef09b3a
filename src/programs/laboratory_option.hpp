#pragma once

#include "clog/cli/command_line.hpp"

namespace clog::programs {

/// Sets the keys that the file of --lab determines, if there is one. @throws Error
void use_laboratory(cli::CommandLine& line);

/// @throws Error  if there is a file of --lab, and circles are drawn for a droplet of another diameter
void refuse_other_droplets(const cli::CommandLine& line);

}  // namespace clog::programs

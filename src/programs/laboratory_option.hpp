#pragma once

#include "clog/cli/command_line.hpp"

namespace clog::programs {

/// Sets the keys that the file of --lab determines, if there is one, and says which. @throws Error  also if
/// the circles are drawn for another droplet
void use_laboratory(cli::CommandLine& line);

}  // namespace clog::programs

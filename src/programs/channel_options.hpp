#pragma once

#include "clog/cli/command_line.hpp"
#include "clog/core/run/systems.hpp"

namespace clog::programs {

/// Declares --orifice, --wedge-angle and --tip-radius.
void add_channel_options(cli::CommandLine& line);
/// The channel that they describe; `start` and `end` are left at their defaults. @throws Error
ChannelParameters channel_from(const cli::CommandLine& line);

}  // namespace clog::programs

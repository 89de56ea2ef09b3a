#pragma once

#include "clog/cli/command_line.hpp"
#include "clog/store/run_table.hpp"

namespace clog::programs {

/// `clogsweep NAME FILE`: a command that reads a sweep's file.
cli::CommandLine file_command(const char* name, const char* usage);
/// Parses what follows the command's name. Returns whether there is something to do. @throws Error
bool parse_file_command(cli::CommandLine& line, int argc, const char* const* argv);

/// Provenance of a table that a command makes from others.
store::Provenance origin_of_table(const cli::CommandLine& line);

}  // namespace clog::programs

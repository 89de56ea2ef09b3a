#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "clog/cli/command_line.hpp"

namespace clog::cli {

/// Runs a program's body; an Error, or output that cannot be written, becomes one line on the error stream
/// and exit code 2.
int run_program(const std::string& program, const std::function<int()>& body);

using NamedTexts = std::vector<std::pair<std::string, std::string>>;

/// Prints the answer to --help or --version, if one of them was given, and returns whether it did.
/// @param libraries  names and versions, printed after the program's own
bool answer_help_or_version(const CommandLine& line, const NamedTexts& libraries);

/// Where a file comes from: program, version, what git says of its sources, compiler, config, command line,
/// time.
NamedTexts origin(const CommandLine& line);

}  // namespace clog::cli

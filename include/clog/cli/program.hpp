#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "clog/cli/command_line.hpp"

namespace clog::cli {

/// Runs a program's body. If the body throws an Error, or its output cannot be written, prints one line on
/// the error stream and returns exit code 2.
int run_program(const std::string& program, const std::function<int()>& body);

/// A command of a program, such as `clogsweep merge`.
struct Command {
  const char* name;
  int (*call)(int argc, const char* const* argv);
};
/// Runs the command named by the first word, as run_program() does. Returns nullopt if the word names no
/// command.
std::optional<int> run_command(const std::string& program, std::span<const Command> commands, int argc,
                               const char* const* argv);

std::vector<std::string> names_of(std::span<const Command> commands);

using NamedTexts = std::vector<std::pair<std::string, std::string>>;

/// Parses the line, and prints the answer to --help or --version. Returns whether there is anything else to
/// do.
/// @param libraries  names and versions of libraries, printed after those of the program
bool parse_command(CommandLine& line, int argc, const char* const* argv, const NamedTexts& libraries = {});

/// The origin of a file: program, version, `git describe` of the program's sources, compiler, config, command
/// line, time.
NamedTexts origin(const CommandLine& line);

}  // namespace clog::cli

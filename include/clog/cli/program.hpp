#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "clog/cli/command_line.hpp"

namespace clog::cli {

inline constexpr int exit_success = 0;
inline constexpr int exit_internal_fault = 1;
inline constexpr int exit_user_fault = 2;
/// Stopped before the end; the same command makes sense again.
inline constexpr int exit_incomplete = 75;
/// The reader of the output went away before its end: what a shell shows for programs that SIGPIPE has ended.
inline constexpr int exit_reader_gone = 141;

/// A signal ended what the program was waiting for; it leaves with exit_incomplete.
class Stopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What every program does first. Descriptors 0 to 2 that are closed are opened on /dev/null: files and
/// sockets would get their numbers otherwise, and with them what is printed. A reader that goes away does not
/// end the program (SIGPIPE is ignored); what is printed to std::cout from then on throws, and run_program()
/// knows what it means.
void prepare_streams();

/// Prints a line on the error stream, control characters escaped.
void say(const std::string& line);

/// Hands everything printed so far to the system. @throws std::ios_base::failure if it cannot be written
void flush_output();

/// Runs a program's body; an Error, or output that cannot be written, becomes one line on the error stream
/// and exit code 2.
int run_program(const std::string& program, const std::function<int()>& body);

using NamedTexts = std::vector<std::pair<std::string, std::string>>;

/// Prints the answer to --help or --version, if one of them was given, and returns whether it did.
/// @param libraries  names and versions, printed after the program's own
bool answer_help_or_version(const CommandLine& line, const NamedTexts& libraries);

/// Where a file comes from: program, version, git hash, compiler, config, command line, time.
NamedTexts origin(const CommandLine& line);

/// From now on SIGINT, SIGTERM and SIGUSR1 only raise a flag.
void catch_stop_signals();
bool stop_signalled();

}  // namespace clog::cli

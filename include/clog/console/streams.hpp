#pragma once

#include <string>

namespace clog::console {

/// What every program does first. Descriptors 0 to 2 that are closed are opened on /dev/null: files and
/// sockets would get their numbers otherwise, and with them what is printed. A reader that goes away does not
/// end the program (SIGPIPE is ignored); what is printed to std::cout from then on throws. A file that may
/// not grow (SIGXFSZ) is one that cannot be written.
void prepare_streams();

/// Prints a line on the error stream, control characters escaped.
void say(const std::string& line);

/// Hands everything printed so far to the system. @throws std::ios_base::failure if it cannot be written
void flush_output();

/// Has everybody left who could read the output?
bool is_reader_gone();

}  // namespace clog::console

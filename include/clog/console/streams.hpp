#pragma once

#include <string>

namespace clog::console {

/// Call this first in every program. If one of the descriptors 0 to 2 is closed, opens it on /dev/null.
/// Otherwise the next file or socket would get the number of the closed descriptor and receive the program's
/// output. Ignores SIGPIPE, so that a closed reader does not end the program; printing to std::cout then
/// throws. Ignores SIGXFSZ, so that writing a file beyond its size limit fails instead of ending the program.
void prepare_streams();

/// Prints a line on the error stream, control characters escaped.
void say(const std::string& line);

/// Passes everything printed so far to the system. @throws std::ios_base::failure if it cannot be written
void flush_output();

/// Whether the reader of the output has closed it.
bool is_reader_gone();

}  // namespace clog::console

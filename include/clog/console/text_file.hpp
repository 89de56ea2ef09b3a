#pragma once

#include <string>

namespace clog::console {

/// The whole text of a file, or of a pipe (`/dev/stdin`, `<(command)`), which is read to its end; without a
/// UTF-8 byte-order mark.
/// @throws Error if it is something else, or cannot be read; Stopped if a signal comes meanwhile
std::string read_text(const std::string& path);

}  // namespace clog::console

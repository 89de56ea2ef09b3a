#pragma once

#include <string>

namespace clog::console {

/// The whole text of a file, or of a pipe (`/dev/stdin`, `<(command)`), which is read to its end. Lines end
/// with \n alone. Text that begins with a byte-order mark, of UTF-8 or UTF-16, is without it, and in UTF-8.
/// @throws Error if it is something else, or cannot be read; Stopped if a signal comes meanwhile
std::string read_text(const std::string& path);

}  // namespace clog::console

#pragma once

#include <string>

namespace clog::console {

/// The whole text of a file or a pipe (`/dev/stdin`, `<(command)`). A pipe is read to its end. Lines of the
/// returned text end with \n alone. Converts UTF-16 to UTF-8 and removes a byte-order mark. @throws Error for
/// text in another encoding, or if the file cannot be read; Stopped if a signal arrives during the reading
std::string read_text(const std::string& path);

}  // namespace clog::console

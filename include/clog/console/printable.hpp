#pragma once

#include <string>
#include <string_view>

namespace clog::console {

/// The text as one line that a terminal takes for nothing but text: control characters, and bytes that are no
/// UTF-8, are written as escapes. Names and values that a message repeats may hold any of them.
std::string printable(std::string_view text);

}  // namespace clog::console

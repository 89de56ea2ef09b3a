#pragma once

#include <string>
#include <string_view>

namespace clog::console {

/// The text as one harmless line for a terminal: control characters, and bytes that are not UTF-8, are
/// escaped. Names and values in a message may contain any of them.
std::string printable(std::string_view text);

}  // namespace clog::console

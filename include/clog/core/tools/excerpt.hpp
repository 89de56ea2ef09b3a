#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace clog {

/// A word for a message, shortened if it would fill a screen.
inline std::string excerpt(std::string_view word) {
  constexpr std::size_t longest = 80;
  return word.size() > longest ? std::string(word.substr(0, longest)) + "..." : std::string(word);
}

}  // namespace clog

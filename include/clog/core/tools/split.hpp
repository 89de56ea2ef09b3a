#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace clog {

/// The parts of a text between commas, including blanks; one part if there is no comma.
inline std::vector<std::string> split_at_commas(std::string_view text) {
  std::vector<std::string> parts(1);
  for (const char letter : text)
    if (letter == ',')
      parts.emplace_back();
    else
      parts.back() += letter;
  return parts;
}

}  // namespace clog

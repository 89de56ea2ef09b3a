#pragma once

#include <charconv>
#include <string>

namespace clog {

/// Shortest decimal text that reads back as the same number, e.g. 0.3, 2e5.
inline std::string shortest(double value) {
  char digits[32];
  std::string text(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  // As people write it: 2e5 instead of 2e+05, 1e-9 instead of 1e-09.
  if (const auto exponent = text.find('e'); exponent != std::string::npos) {
    if (text[exponent + 1] == '+') text.erase(exponent + 1, 1);
    const std::size_t begin = exponent + (text[exponent + 1] == '-' ? 2 : 1);
    if (text[begin] == '0') text.erase(begin, 1);
  }
  return text;
}

}  // namespace clog

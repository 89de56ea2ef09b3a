#pragma once

#include <charconv>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>

namespace clog {

/// Shortest decimal text that reads back as the same number, e.g. 0.3, 2e5.
inline std::string shortest(double value) {
  char digits[32];
  std::string text(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  // Exponents as people write them: 2e5 instead of 2e+05, 1e-9 instead of 1e-09.
  if (const auto exponent = text.find('e'); exponent != std::string::npos) {
    if (text[exponent + 1] == '+') text.erase(exponent + 1, 1);
    const std::size_t begin = exponent + (text[exponent + 1] == '-' ? 2 : 1);
    if (text[begin] == '0') text.erase(begin, 1);
  }
  return text;
}

/// A share as people write it: 0.125 is `12.5%`. Twelve digits avoid 28.999999999999996%.
inline std::string share_text(double share) {
  char digits[32];
  const char* const end =
      std::to_chars(digits, digits + sizeof digits, 100 * share, std::chars_format::general, 12).ptr;
  double percent = 0;
  std::from_chars(digits, end, percent);
  return shortest(percent) + '%';
}
/// The share that a text like `12.5%` gives; NaN unless the text is a number and a `%`.
inline double share_of(std::string_view text) {
  double percent = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, percent);
  const bool is_share = error == std::errc() && std::string_view(rest, end) == "%";
  return is_share ? percent / 100 : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace clog

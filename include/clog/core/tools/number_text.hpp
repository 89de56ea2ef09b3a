#pragma once

#include <charconv>
#include <cmath>
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

/// The number rounded to twelve digits. This removes the round-off of a calculation or a conversion between
/// units: 1.2 - 0.3 is 0.8999999999999999 and becomes 0.9.
inline double twelve_digits(double value) {
  if (!std::isfinite(value) || value == std::trunc(value)) return value;
  char digits[32];
  const char* const end =
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 12).ptr;
  std::from_chars(digits, end, value);
  return value;
}

/// A share as people write it: 0.125 is `12.5%`.
inline std::string share_text(double share) { return shortest(twelve_digits(100 * share)) + '%'; }
/// The share that a text like `12.5%` gives; NaN unless the text is a number and a `%`.
inline double share_of(std::string_view text) {
  double percent = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, percent);
  const bool is_share = error == std::errc() && std::string_view(rest, end) == "%";
  return is_share ? percent / 100 : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace clog

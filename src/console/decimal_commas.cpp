#include "clog/console/decimal_commas.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/excerpt.hpp"

namespace clog::console {

bool may_have_thousands(std::string_view number) {
  if (number.starts_with('-') || number.starts_with('+')) number.remove_prefix(1);
  const std::size_t first = number.find(',');
  if (first == 0 || first > 3 || number.starts_with('0')) return false;
  for (std::size_t comma = first; comma < number.size(); comma += 4)
    if (number[comma] != ',' || number.size() - comma < 4) return false;
  return true;
}

std::string DecimalCommas::with_point(std::string number) {
  const bool has_comma = number.find(',') != std::string::npos;
  const bool has_point = number.find('.') != std::string::npos;
  if (has_comma && has_point) refuse("", number);
  if (has_comma && with_comma_.empty()) with_comma_ = number;
  if (has_point && with_point_.empty()) with_point_ = number;
  if (!with_comma_.empty() && !with_point_.empty()) {
    const std::string& other = has_comma ? with_point_ : with_comma_;
    throw Error(fmt::format(
        "'{}' has a {}, but '{}' above has a {}; write all numbers of the file with decimal points, and "
        "without commas",
        excerpt(number), has_comma ? "comma" : "point", excerpt(other), has_comma ? "point" : "comma"));
  }
  if (!has_comma) return number;
  if (!may_have_thousands(number))
    is_one_decimal_ = true;
  else if (perhaps_thousands_.empty())
    perhaps_thousands_ = number;
  std::ranges::replace(number, ',', '.');
  return number;
}

std::string DecimalCommas::with_point(const std::string& column, const std::string& cell, char separator) {
  try {
    if (separator == ',' && may_have_thousands(cell)) refuse("", cell);
    return with_point(cell);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", column, error.what()));
  }
}

void DecimalCommas::check(const std::string& path) const {
  if (!is_one_decimal_ && !perhaps_thousands_.empty()) refuse(path + ": ", perhaps_thousands_);
}

void DecimalCommas::refuse(std::string_view where, const std::string& number) {
  throw Error(
      fmt::format("{}'{}' may have a decimal comma or separated thousands; write all numbers with decimal "
                  "points and without commas",
                  where, excerpt(number)));
}

}  // namespace clog::console

#include "clog/console/decimal_commas.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>

#include "clog/core/tools/error.hpp"

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
  if (number.find(',') == std::string::npos) return number;
  if (!may_have_thousands(number))
    is_one_decimal_ = true;
  else if (perhaps_thousands_.empty())
    perhaps_thousands_ = number;
  std::ranges::replace(number, ',', '.');
  return number;
}

void DecimalCommas::check(const std::string& path) const {
  if (!is_one_decimal_ && !perhaps_thousands_.empty()) refuse(path + ": ", perhaps_thousands_);
}

void DecimalCommas::refuse(std::string_view where, const std::string& number) {
  constexpr std::size_t longest = 80;
  throw Error(
      fmt::format("{}'{}' may have a decimal comma or separated thousands; write all numbers with decimal "
                  "points and without commas",
                  where, number.substr(0, longest)));
}

}  // namespace clog::console

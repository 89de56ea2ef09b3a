#include "clog/sweep/value_list.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/portable_math.hpp"
#include "clog/core/tools/wording.hpp"

namespace clog::sweep {
namespace {

constexpr long long longest_list = 1'000'000;

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Whether the item is n values from a to b, written lin(a,b,n) or log(a,b,n).
bool is_spaced(std::string_view item) { return item.starts_with("lin(") || item.starts_with("log("); }

/// The arguments of lin(a,b,n) or log(a,b,n), with or without a closing parenthesis.
std::vector<std::string_view> arguments_of(std::string_view item) {
  return split_list(item.substr(4, item.size() - (item.ends_with(')') ? 5 : 4)));
}

[[noreturn]] void refuse(std::string_view item, const std::string& why) {
  throw Error(fmt::format("'{}' {}", item, why));
}

void check_length(std::string_view item, long long length) {
  if (length < 1) refuse(item, "has no values");
  if (length > longest_list) refuse(item, "has more than a million values");
}

std::vector<std::string> expand_spaced(std::string_view item, ValueKind kind) {
  const bool logarithmic = item.starts_with("log(");
  if (!item.ends_with(")")) refuse(item, "lacks its closing parenthesis");
  const std::vector<std::string_view> arguments = arguments_of(item);
  if (arguments.size() != 3) refuse(item, "needs three arguments: first, last, number of values");
  const double first = to_number(arguments[0]);
  const double last = to_number(arguments[1]);
  const long long count = to_integer(arguments[2]);
  check_length(item, count);
  if (logarithmic && !(first > 0 && last > 0)) refuse(item, "needs positive ends");
  std::vector<std::string> values;
  for (long long i = 0; i < count; ++i) {
    const double fraction = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.0;
    double value =
        logarithmic ? first * portable::pow(last / first, fraction) : std::lerp(first, last, fraction);
    if (i == count - 1 && count > 1) value = last;
    // Values are rounded to twelve digits, as a user would write them; otherwise the file would contain
    // 0.30000000000000004.
    if (i > 0 && i < count - 1) {
      char digits[32];
      const char* const end =
          std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 12).ptr;
      value = to_number({digits, static_cast<std::size_t>(end - digits)});
    }
    if (kind == ValueKind::integer && value != std::round(value))
      refuse(item, "gives values that are not integers");
    const bool as_integer = kind == ValueKind::integer && std::abs(value) < 1e15;
    values.push_back(as_integer ? std::to_string(static_cast<long long>(value)) : shortest(value));
  }
  return values;
}

std::vector<std::string> expand_range(std::string_view item, std::size_t dots) {
  const long long first = to_integer(trimmed(item.substr(0, dots)));
  const std::size_t colon = std::min(item.find(':', dots), item.size());
  const long long last = to_integer(trimmed(item.substr(dots + 2, colon - dots - 2)));
  const long long step = colon == item.size() ? 1 : to_integer(trimmed(item.substr(colon + 1)));
  if (step < 1) refuse(item, "needs a step of 1 or more");
  if (last < first) refuse(item, "has no values");
  // The type is unsigned, so that the difference of any two integers fits.
  const auto steps = (static_cast<unsigned long long>(last) - static_cast<unsigned long long>(first)) /
                     static_cast<unsigned long long>(step);
  check_length(item, static_cast<long long>(std::min<unsigned long long>(steps, longest_list)) + 1);
  std::vector<std::string> values;
  for (unsigned long long i = 0; i <= steps; ++i)
    values.push_back(std::to_string(first + static_cast<long long>(i) * step));
  return values;
}

/// Refuses other notations for integers and ranges of integers. The message names the accepted notation.
void refuse_other_notations(std::string_view item) {
  constexpr std::string_view digits = "0123456789";
  constexpr auto none = std::string_view::npos;
  if (const auto dash = item.find('-', 1); dash != none)
    if (const std::string range =
            fmt::format("{}..{}", trimmed(item.substr(0, dash)), trimmed(item.substr(dash + 1)));
        range.find_first_not_of("0123456789.") == none)
      refuse(item, fmt::format("is not an integer; a range has two points, {}", range));
  const auto colon = item.find(':');
  if (colon != none && item.find_first_not_of("0123456789: ") == none) {
    const std::string_view first = trimmed(item.substr(0, colon)), last = trimmed(item.substr(colon + 1));
    const bool is_range = last.find(':') == none;
    refuse(item, is_range ? fmt::format("is not an integer; a range has two points, {}..{}", first, last)
                          : std::string(
                                "is not an integer; a range with a step is FIRST..LAST:STEP, as in 1..10:2"));
  }
  if (item.find_first_of("; ") != none && item.find_first_not_of("0123456789; ") == none) {
    std::string list;
    for (const char letter : item) {
      const bool is_digit = digits.find(letter) != none;
      if (is_digit || !list.ends_with(',')) list += is_digit ? letter : ',';
    }
    refuse(item, fmt::format("is not an integer; commas separate values, {}", list));
  }
  double value = 0;
  const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), value);
  constexpr double largest = 1e15;
  if (error == std::errc() && end == item.data() + item.size() && item.find_first_not_of(digits, 1) != none &&
      value == std::round(value) && std::abs(value) < largest)
    refuse(item, fmt::format("is not written as an integer; did you mean {:.0f}?", value));
}

std::vector<std::string> expand_item(std::string_view item, ValueKind kind,
                                     const std::vector<std::string>& words) {
  if (item.empty()) throw Error("has an empty value");
  if (std::find(words.begin(), words.end(), item) != words.end()) return {std::string(item)};
  if (kind == ValueKind::word) {
    const std::string near = did_you_mean(item, words);
    refuse(item, "is not one of " + joined(words) + (near.empty() ? "" : "; did you mean " + near + '?'));
  }
  if (kind == ValueKind::file || kind == ValueKind::text) return {std::string(item)};
  if (is_spaced(item)) return expand_spaced(item, kind);
  if (const auto dots = item.find(".."); dots != std::string_view::npos) {
    if (kind == ValueKind::integer) return expand_range(item, dots);
    const std::string_view first = item.substr(0, dots), rest = item.substr(dots + 2);
    const std::string_view last = rest.substr(0, rest.find(':'));
    refuse(item, fmt::format(
                     "is a range of integers, but the key takes any number; give how many, e.g. lin({},{},5)",
                     first, last));
  }
  if (kind == ValueKind::integer) refuse_other_notations(item);
  if (kind == ValueKind::integer) return {std::to_string(to_integer(item))};
  if (kind == ValueKind::number_or_share && item.ends_with('%'))
    return {shortest(to_number(item.substr(0, item.size() - 1))) + '%'};
  return {shortest(to_number(item))};
}

/// @param rest  the text that follows the number
[[noreturn]] void refuse_number(std::string_view text, std::string_view rest, const std::string& why) {
  constexpr std::string_view no_unit = ".+-*/0123456789:;,()=";
  rest = trimmed(rest);
  const bool is_per_area =
      rest.starts_with('/') && rest.size() > 1 && no_unit.find(rest[1]) == std::string_view::npos;
  const bool has_unit = rest.size() < text.size() && !rest.empty() &&
                        (is_per_area || no_unit.find(rest[0]) == std::string_view::npos);
  if (has_unit) throw NumberWithUnit(fmt::format("'{}' {}", text, why));
  refuse(text, why);
}

std::string question_of_comma(std::string_view text) {
  const std::string meant = with_decimal_point(text);
  return meant.empty() ? "" : fmt::format("; did you mean {}?", meant);
}

}  // namespace

std::vector<std::string_view> split_list(std::string_view list) {
  std::vector<std::string_view> items;
  int depth = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= list.size(); ++i) {
    if (i == list.size() || (list[i] == ',' && depth == 0)) {
      items.push_back(trimmed(list.substr(begin, i - begin)));
      begin = i + 1;
    } else if (list[i] == '(') {
      ++depth;
    } else if (list[i] == ')') {
      --depth;
    }
  }
  return items;
}

std::vector<std::string_view> numbers_in(std::string_view list) {
  std::vector<std::string_view> numbers;
  for (const std::string_view item : split_list(list)) {
    if (!is_spaced(item)) {
      numbers.push_back(item);
      continue;
    }
    const std::vector<std::string_view> arguments = arguments_of(item);
    numbers.insert(numbers.end(), arguments.begin(),
                   arguments.begin() + std::min<std::ptrdiff_t>(2, std::ssize(arguments)));
  }
  return numbers;
}

std::vector<std::string> expand_values(std::string_view text, ValueKind kind,
                                       const std::vector<std::string>& words) {
  std::vector<std::string> values;
  for (const std::string_view item : split_list(text)) {
    for (std::string& value : expand_item(item, kind, words)) values.push_back(std::move(value));
    if (std::ssize(values) > longest_list) throw Error("has more than a million values in all");
  }
  return values;
}

std::vector<std::string> expand_list(std::string_view text, ValueKind kind,
                                     const std::vector<std::string>& words) {
  std::vector<std::string> values = expand_values(text, kind, words);
  std::vector<std::string> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end())
    refuse(*twice, "stands in the list twice: the same runs would be done again");
  return values;
}

std::string with_decimal_point(std::string_view text) {
  if (text.ends_with('%')) {
    const std::string number = with_decimal_point(text.substr(0, text.size() - 1));
    return number.empty() ? "" : number + '%';
  }
  constexpr std::string_view digits = "0123456789";
  const auto comma = text.find(',');
  if (comma == 0 || comma == std::string_view::npos || comma + 1 == text.size()) return "";
  const std::string_view whole = text.substr(0, comma);
  const std::string_view fraction = text.substr(comma + 1);
  constexpr auto none = std::string_view::npos;
  if (whole.find_first_not_of(digits) != none || fraction.find_first_not_of(digits) != none) return "";
  return fmt::format("{}.{}", whole, fraction);
}

double to_number(std::string_view text) {
  double value = 0;
  const bool has_plus = text.starts_with('+') && !text.starts_with("+-");  // from_chars refuses it
  const char* begin = text.data() + (has_plus ? 1 : 0);
  const char* const text_end = text.data() + text.size();
  const auto [end, error] = std::from_chars(begin, text_end, value);
  if (error != std::errc() || end != text_end || !std::isfinite(value))
    refuse_number(text, {end, text_end}, "is not a finite number" + question_of_comma(text));
  return value;
}

long long to_integer(std::string_view text) {
  long long value = 0;
  const char* const text_end = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), text_end, value);
  if (error != std::errc() || end != text_end) refuse_number(text, {end, text_end}, "is not an integer");
  return value;
}

}  // namespace clog::sweep

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "clog/core/parameters/schema.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/number_text.hpp"

namespace clog::sweep {

/// Splits a list as written in a config file into single values, in order: `0.2,0.3`; `lin(a,b,n)` and
/// `log(a,b,n)`, n values from a to b; for integers `1..50`; words as they are.
/// Numbers come back in their shortest exact decimal form.
/// @param words  words allowed instead of a number (e.g. auto), or all words allowed for kind word
/// @throws Error that names the faulty item, but not the key
std::vector<std::string> expand_list(std::string_view text, ValueKind kind,
                                     const std::vector<std::string>& words);
/// Splits a list like expand_list(), but values may repeat.
std::vector<std::string> expand_values(std::string_view text, ValueKind kind,
                                       const std::vector<std::string>& words);

/// The items of a list without blanks around them: commas outside parentheses separate them.
std::vector<std::string_view> split_list(std::string_view list);
/// The numbers in a list, as they are written, perhaps with units. The numbers are the items of the list; an
/// item lin(a,b,n) or log(a,b,n) contributes a and b.
std::vector<std::string_view> numbers_in(std::string_view list);

using clog::shortest;

/// The error for a text in which a number is followed by a word that looks like a unit.
struct NumberWithUnit : Error {
  using Error::Error;
};
/// @throws Error if the whole text is not one finite number, NumberWithUnit if a unit follows the number
double to_number(std::string_view text);
/// @throws Error if the whole text is not one integer, NumberWithUnit if a unit follows the number
long long to_integer(std::string_view text);

/// The number `0.3` that `0,3` means with a decimal comma; empty for any other text.
std::string with_decimal_point(std::string_view text);

}  // namespace clog::sweep

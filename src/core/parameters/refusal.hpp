#pragma once

#include <concepts>
#include <initializer_list>
#include <string>

#include "clog/core/parameters/refusal.hpp"
#include "clog/core/tools/number_text.hpp"

namespace clog {

/// Other keys whose values a text contains.
using Named = std::initializer_list<const char*>;

[[noreturn]] inline void refuse(const char* key, const std::string& value,
                                const std::string& reason_and_remedy, Named named = {}) {
  throw Refusal({.key = key, .named = {named.begin(), named.end()}},
                std::string("invalid ") + key + '=' + value + " (" + reason_and_remedy);
}
[[noreturn]] inline void refuse(const char* key, double value, const std::string& reason_and_remedy,
                                Named named = {}) {
  refuse(key, shortest(value), reason_and_remedy, named);
}

inline void require(bool holds, const char* key, double value, const char* reason_and_remedy,
                    Named named = {}) {
  if (!holds) refuse(key, value, reason_and_remedy, named);
}
/// @param reason_and_remedy  makes the text. It is called only for a refusal, because formatting a text in
/// every check would take most of the time for planning a large sweep.
template <std::invocable Words>
void require(bool holds, const char* key, double value, const Words& reason_and_remedy, Named named = {}) {
  if (!holds) refuse(key, value, reason_and_remedy(), named);
}

/// Rounds down to this number of digits.
double rounded_down(double value, int digits = 2);

}  // namespace clog

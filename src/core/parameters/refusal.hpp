#pragma once

#include <concepts>
#include <string>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/number_text.hpp"

namespace clog {

[[noreturn]] inline void refuse(const char* key, const std::string& value,
                                const std::string& reason_and_remedy) {
  throw Error(std::string("invalid ") + key + '=' + value + " (" + reason_and_remedy);
}
[[noreturn]] inline void refuse(const char* key, double value, const std::string& reason_and_remedy) {
  refuse(key, shortest(value), reason_and_remedy);
}

inline void require(bool holds, const char* key, double value, const char* reason_and_remedy) {
  if (!holds) refuse(key, value, reason_and_remedy);
}
/// @param reason_and_remedy  makes the text. It is called only on refusal, because formatting a text for
/// every check would take most of the time for planning a large sweep.
template <std::invocable Words>
void require(bool holds, const char* key, double value, const Words& reason_and_remedy) {
  if (!holds) refuse(key, value, reason_and_remedy());
}

/// Rounds down to this number of digits.
double rounded_down(double value, int digits = 2);

}  // namespace clog

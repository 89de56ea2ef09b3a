#pragma once

#include <string>

namespace clog::console {

/// Numbers for people, with as many figures as their uncertainty allows: analysis/clogsweep/tools/rounded.py
/// has the same rule.

inline constexpr int least_figures = 3;

/// @param value  a dash replaces values that are not finite
std::string plain(double value, int figures = least_figures);

struct RoundedInterval {
  std::string value, lower, upper;
};
/// Two figures of the narrower side of the interval, but at least three of each number.
RoundedInterval with_interval(double value, double lower, double upper);

struct RoundedError {
  std::string value, error;
};
/// Two figures of the error; without an error three of the value, at most eight.
RoundedError with_error(double value, double error);

}  // namespace clog::console

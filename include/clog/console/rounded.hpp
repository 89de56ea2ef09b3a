#pragma once

#include <string>

namespace clog::console {

/// Numbers for people, with as many figures as their uncertainty allows: analysis/clogsweep/tools/rounded.py
/// has the same rule.

inline constexpr int least_figures = 3;

/// @param value  a dash stands for what is not finite
std::string plain(double value, int figures = least_figures);

struct RoundedInterval {
  std::string value, lower, upper;
};
/// Two figures of the narrower side of the interval, but three of each number at least.
RoundedInterval with_interval(double value, double lower, double upper);

struct RoundedError {
  std::string value, error;
};
/// Two figures of the error; where there is none, three of the value, which has eight at most.
RoundedError with_error(double value, double error);

}  // namespace clog::console

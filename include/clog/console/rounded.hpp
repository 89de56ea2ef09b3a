#pragma once

#include <string>

namespace clog::console {

/// Numbers for people, with as many figures as their uncertainty justifies.
/// analysis/clogsweep/tools/rounded.py rounds in the same way.

inline constexpr int least_figures = 3;

/// @param value  printed as a dash if it is not finite
std::string plain(double value, int figures = least_figures);

struct RoundedInterval {
  std::string value, lower, upper;
};
/// A value and the limits of its interval, all three with the same number of figures. This number is at least
/// three, and large enough to show the narrower side of the interval with two figures.
RoundedInterval with_interval(double value, double lower, double upper);

struct RoundedError {
  std::string value, error;
};
/// The error with two figures, and the value rounded to the same digit, but with at most eight figures.
/// Without an error, the value has three figures.
RoundedError with_error(double value, double error);

}  // namespace clog::console

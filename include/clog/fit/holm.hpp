#pragma once

#include <span>
#include <vector>

namespace clog::fit {

/// The p-values of several tests, adjusted by Holm's method (Scand. J. Stat. 6, 65 (1979)): each value is
/// multiplied so that, if all hypotheses are true, only one family of tests in twenty has a value below 0.05.
/// NaN is not counted as a test, and stays NaN.
std::vector<double> holm_adjusted(std::span<const double> p_values);

}  // namespace clog::fit

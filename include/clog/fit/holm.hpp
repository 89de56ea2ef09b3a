#pragma once

#include <span>
#include <vector>

namespace clog::fit {

/// The p-values of several tests, each multiplied so that, if all hypotheses are true, only one family of
/// tests in twenty has a value below 0.05 (Holm, Scand. J. Stat. 6, 65 (1979)). NaN are no tests, and stay.
std::vector<double> holm_adjusted(std::span<const double> p_values);

}  // namespace clog::fit

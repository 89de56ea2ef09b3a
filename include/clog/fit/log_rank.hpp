#pragma once

#include <span>
#include <vector>

#include "clog/fit/clogging_length.hpp"

namespace clog::fit {

/// The p-value of the hypothesis that both sides have the same P(r), whatever its law: the log-rank test
/// (N. Mantel, Cancer Chemotherapy Reports 50, 163 (1966)), two-sided, with chi-squared's distribution. All
/// runs count as independent. NaN if one side has no runs, or if no clog tells the sides apart.
double log_rank_p_value(std::span<const Observation> here, std::span<const Observation> there);

/// The p-values of several tests, each multiplied so that, if all hypotheses are true, only one family of
/// tests in twenty has a value below 0.05 (Holm, Scand. J. Stat. 6, 65 (1979)). NaN are no tests, and stay.
std::vector<double> holm_adjusted(std::span<const double> p_values);

}  // namespace clog::fit

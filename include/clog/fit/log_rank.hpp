#pragma once

#include <span>

#include "clog/fit/clogging_length.hpp"

namespace clog::fit {

/// The p-value of the hypothesis that both sides have the same P(r), whatever its law: the log-rank test
/// (N. Mantel, Cancer Chemotherapy Reports 50, 163 (1966)), two-sided, with chi-squared's distribution. All
/// runs count as independent. NaN if one side has no runs, or if no clog tells the sides apart.
double log_rank_p_value(std::span<const Observation> here, std::span<const Observation> there);

}  // namespace clog::fit

#pragma once

#include <span>

#include "clog/fit/clogging_length.hpp"

namespace clog::fit {

/// The p-value of the hypothesis that both sides have equal P(r), whatever the law of P(r). The test is the
/// two-sided log-rank test (N. Mantel, Cancer Chemotherapy Reports 50, 163 (1966)), with the chi-squared
/// distribution. All runs count as independent. NaN if one side has no runs, or if no clog distinguishes the
/// sides.
double log_rank_p_value(std::span<const Observation> here, std::span<const Observation> there);

}  // namespace clog::fit

#pragma once

#include "clog/fit/clogging_length.hpp"

namespace clog::fit {

/// Interval of the probability of an event that occurred in num_hits of num_trials trials (Clopper and
/// Pearson, Biometrika 26, 404 (1934)); from 0 to 1 without trials. Fractions of trials interpolate. @throws
/// std::invalid_argument unless 0 < confidence < 1
Interval share_interval(double num_hits, double num_trials, double confidence);

}  // namespace clog::fit

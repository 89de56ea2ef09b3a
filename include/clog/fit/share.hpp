#pragma once

#include "clog/fit/clogging_length.hpp"

namespace clog::fit {

/// Interval of a probability, from how often it happened (Clopper and Pearson, Biometrika 26, 404 (1934));
/// from 0 to 1 without trials. @throws std::invalid_argument unless 0 < confidence < 1
Interval share_interval(int num_hits, int num_trials, double confidence);

}  // namespace clog::fit

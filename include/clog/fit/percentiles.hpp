#pragma once

#include <cstddef>
#include <vector>

#include "clog/fit/clogging_length.hpp"

namespace clog::fit {

/// Interval of an estimate from its values in bootstrap resamples: percentiles, farther apart the fewer units
/// the sample has, by the quantile of Student's t (Hesterberg, Am. Stat. 69, 371 (2015), expanded
/// percentiles). NaN if all values are equal, as for a single unit, or if they are too few for this
/// confidence. @throws std::invalid_argument unless 0 < confidence < 1
Interval percentile_interval(std::vector<double> values, std::size_t num_units, double confidence);

}  // namespace clog::fit

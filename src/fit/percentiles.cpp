#include "clog/fit/percentiles.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace clog::fit {

Interval percentile_interval(std::vector<double> values, std::size_t num_units, double confidence) {
  require_confidence(confidence);
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(values);
  if (num_units < 2 || values.front() == values.back()) return {unknown, unknown};
  const auto n = static_cast<double>(num_units);
  const double t = quantile(complement(boost::math::students_t(n - 1), (1 - confidence) / 2));
  const double each_side = cdf(boost::math::normal(), -std::sqrt(n / (n - 1)) * t);
  const double last = static_cast<double>(values.size() - 1), tail = each_side * last;
  if (tail < 1) return {unknown, unknown};
  return {values[static_cast<std::size_t>(tail)], values[static_cast<std::size_t>(std::ceil(last - tail))]};
}

}  // namespace clog::fit

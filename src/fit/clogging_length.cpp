#include "clog/fit/clogging_length.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace clog::fit {

CloggingLength fit_clogging_length(std::span<const Observation> runs, double confidence) {
  if (!(confidence > 0 && confidence < 1)) throw std::invalid_argument("confidence must lie between 0 and 1");
  CloggingLength fit;
  fit.num_runs = static_cast<int>(runs.size());
  for (const Observation& run : runs) {
    fit.total_distance += std::max(0.0, run.distance);
    fit.num_clogs += run.clogged;
  }
  if (fit.num_clogs == 0) {
    fit.length = std::numeric_limits<double>::quiet_NaN();
    fit.lower = fit.total_distance / -std::log1p(-confidence);
    fit.upper = std::numeric_limits<double>::infinity();
    return fit;
  }
  const boost::math::chi_squared chi2(2.0 * fit.num_clogs);
  const double tail = (1 - confidence) / 2;
  fit.length = fit.total_distance / fit.num_clogs;
  fit.lower = 2 * fit.total_distance / quantile(complement(chi2, tail));
  fit.upper = 2 * fit.total_distance / quantile(chi2, tail);
  return fit;
}

}  // namespace clog::fit

#include "clog/fit/share.hpp"

#include <boost/math/distributions/binomial.hpp>

namespace clog::fit {

Interval share_interval(double num_hits, double num_trials, double confidence) {
  require_confidence(confidence);
  if (num_trials == 0) return {0, 1};
  using Binomial = boost::math::binomial_distribution<>;
  const double each_side = (1 - confidence) / 2;
  return {Binomial::find_lower_bound_on_p(num_trials, num_hits, each_side),
          Binomial::find_upper_bound_on_p(num_trials, num_hits, each_side)};
}

}  // namespace clog::fit

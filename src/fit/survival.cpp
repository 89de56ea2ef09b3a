#include "clog/fit/survival.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

namespace clog::fit {
namespace {

/// Of the mean distance; shorter ones count as that in the test, for Weibull's law knows no zero.
constexpr double shortest_share = 1e-3;

/// Sums over runs with x = r/(longest r), so that no power overflows.
struct PowerSums {
  double power = 0;      ///< sum x^k
  double power_log = 0;  ///< sum x^k log x
};
PowerSums power_sums(const std::vector<double>& log_x, double shape) {
  PowerSums sums;
  for (const double log : log_x) {
    const double power = std::exp(shape * log);
    sums.power += power;
    sums.power_log += power * log;
  }
  return sums;
}

}  // namespace

std::vector<SurvivalStep> survival_curve(std::span<const Observation> runs) {
  std::vector<Observation> sorted;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(sorted),
               [](const Observation& run) { return !std::isnan(run.distance); });
  std::sort(sorted.begin(), sorted.end(),
            [](const Observation& a, const Observation& b) { return a.distance < b.distance; });
  std::vector<SurvivalStep> steps;
  double probability = 1;
  double variance_sum = 0;  // Greenwood's, of log P
  for (std::size_t begin = 0; begin < sorted.size();) {
    std::size_t end = begin;
    int num_clogs = 0;
    while (end < sorted.size() && sorted[end].distance == sorted[begin].distance)
      num_clogs += sorted[end++].clogged;
    const auto at_risk = static_cast<double>(sorted.size() - begin);
    if (num_clogs > 0) {
      probability *= 1 - num_clogs / at_risk;
      variance_sum += num_clogs / (at_risk * (at_risk - num_clogs));
      const double error = probability > 0 ? probability * std::sqrt(variance_sum) : 0;
      steps.push_back(
          {sorted[begin].distance, static_cast<int>(sorted.size() - begin), num_clogs, probability, error});
    }
    begin = end;
  }
  return steps;
}

WeibullTest test_exponentiality(std::span<const Observation> runs) {
  WeibullTest test;
  double longest = 0;
  double sum = 0;
  for (const Observation& run : runs) {
    longest = std::max(longest, run.distance);
    sum += std::max(0.0, run.distance);
  }
  const double shortest = shortest_share * sum / static_cast<double>(runs.size());
  std::vector<double> log_x;
  double clog_logs = 0;
  double total = 0;
  bool clogs_differ = false;
  double some_clog = 0;
  for (const Observation& run : runs) {
    if (!(longest > 0)) break;
    const double distance = std::max(run.distance, shortest);
    log_x.push_back(std::log(distance / longest));
    total += distance;
    if (!run.clogged) continue;
    clogs_differ = clogs_differ || (test.num_clogs > 0 && distance != some_clog);
    some_clog = distance;
    ++test.num_clogs;
    clog_logs += log_x.back();
  }
  constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
  if (!clogs_differ) {
    test.shape = test.scale = test.exponential_likelihood = test.weibull_likelihood = undefined;
    test.likelihood_ratio = test.p_value = undefined;
    return test;
  }
  const auto d = static_cast<double>(test.num_clogs);
  // The derivative of the profile likelihood in the shape: falls from +infinity to a negative number.
  const auto score = [&](double shape) {
    const PowerSums sums = power_sums(log_x, shape);
    return 1 / shape + clog_logs / d - sums.power_log / sums.power;
  };
  double high = 1;
  while (score(high) > 0) high *= 2;
  double low = high / 2;
  while (score(low) < 0) low /= 2;
  std::uintmax_t most_steps = 200;
  const auto root = boost::math::tools::toms748_solve(
      score, low, high, boost::math::tools::eps_tolerance<double>(), most_steps);
  test.shape = (root.first + root.second) / 2;
  const double scale_power = power_sums(log_x, test.shape).power / d;  // (scale/longest)^shape
  test.scale = longest * std::pow(scale_power, 1 / test.shape);
  test.exponential_likelihood = -d * std::log(total / d) - d;
  test.weibull_likelihood = d * (std::log(test.shape) - std::log(scale_power) - std::log(longest)) +
                            (test.shape - 1) * clog_logs - d;
  test.likelihood_ratio = std::max(0.0, 2 * (test.weibull_likelihood - test.exponential_likelihood));
  test.p_value = cdf(complement(boost::math::chi_squared(1), test.likelihood_ratio));
  return test;
}

}  // namespace clog::fit

#include "clog/fit/survival.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "clog/fit/holm.hpp"

namespace clog::fit {
namespace {

/// Weibull's law excludes zero, so the test raises all distances to at least this fraction of the mean
/// distance.
constexpr double shortest_share = 1e-3;

/// An interval that contains the root of a decreasing function, found by doubling and halving; nullopt if
/// there is no root.
template <class Function>
std::optional<std::pair<double, double>> bracket(const Function& falling) {
  constexpr int most_doublings = 200;  // 2^200 exceeds the ratio of the logarithms of any two doubles
  double high = 1;
  for (int i = 0; falling(high) > 0; ++i, high *= 2)
    if (i == most_doublings) return std::nullopt;
  double low = high / 2;
  for (int i = 0; falling(low) < 0; ++i, low /= 2)
    if (i == most_doublings) return std::nullopt;
  return std::pair(low, high);
}

/// Sums over runs. Here k is the shape and x = r/(longest r), so that no power overflows.
struct PowerSums {
  double power = 0;      ///< sum of x^k
  double power_log = 0;  ///< sum of x^k log x
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

/// Distances of all runs for the test, x = r/(longest r). Short distances are raised to shortest_share times
/// the mean distance.
struct LogWays {
  double longest = 0;         ///< longest distance [sigma]
  std::vector<double> log_x;  ///< log x of every run
  double total = 0;           ///< sum of all x
  double clog_logs = 0;       ///< sum of log x over clogs
};
/// `log_x` is empty if no run has moved, or if a distance is not finite.
LogWays log_ways(std::span<const Observation> runs) {
  LogWays ways;
  for (const Observation& run : runs) ways.longest = std::max(ways.longest, run.distance);
  if (!(ways.longest > 0) || !all_finite(runs)) return ways;
  double sum = 0;
  for (const Observation& run : runs) sum += std::max(0.0, run.distance / ways.longest);
  const double shortest = shortest_share * sum / static_cast<double>(runs.size());
  for (const Observation& run : runs) {
    const double x = std::max(run.distance / ways.longest, shortest);
    ways.log_x.push_back(std::log(x));
    ways.total += x;
    if (run.clogged) ways.clog_logs += ways.log_x.back();
  }
  return ways;
}

}  // namespace

Interval log_log_interval(double probability, double log_variance, double confidence) {
  constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
  if (!(probability > 0 && probability < 1)) return {undefined, undefined};
  const double factor =
      std::exp(normal_deviate(confidence) * std::sqrt(log_variance) / -std::log(probability));
  return {std::pow(probability, factor), std::pow(probability, 1 / factor)};
}

std::vector<SurvivalStep> survival_curve(std::span<const Observation> runs, double confidence) {
  require_confidence(confidence);
  std::vector<Observation> sorted;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(sorted),
               [](const Observation& run) { return !std::isnan(run.distance); });
  std::sort(sorted.begin(), sorted.end(),
            [](const Observation& a, const Observation& b) { return a.distance < b.distance; });
  std::vector<SurvivalStep> steps;
  double probability = 1;
  double variance_sum = 0;  // sum in Greenwood's variance of log P
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
      steps.push_back({sorted[begin].distance, static_cast<int>(sorted.size() - begin), num_clogs,
                       probability, error, log_log_interval(probability, variance_sum, confidence)});
    }
    begin = end;
  }
  return steps;
}

WeibullTest test_exponentiality(std::span<const Observation> runs) {
  WeibullTest test;
  constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
  test.shape = test.scale = test.exponential_likelihood = test.weibull_likelihood = undefined;
  test.likelihood_ratio = test.p_value = undefined;
  test.num_clogs = static_cast<int>(
      std::count_if(runs.begin(), runs.end(), [](const Observation& run) { return run.clogged; }));
  const LogWays ways = log_ways(runs);
  if (test.num_clogs < 2 || ways.log_x.empty()) return test;

  const auto d = static_cast<double>(test.num_clogs);
  const double log_longest = std::log(ways.longest);
  test.exponential_likelihood = -d * (std::log(ways.total / d) + log_longest) - d;
  if (ways.clog_logs == 0) {  // all clogs are at the longest distance
    test.shape = test.weibull_likelihood = test.likelihood_ratio = std::numeric_limits<double>::infinity();
    test.scale = ways.longest;
    test.p_value = 0;
    return test;
  }
  // The derivative of the profile likelihood with respect to the shape. With increasing shape, it falls from
  // +infinity to a negative number.
  const auto score = [&](double shape) {
    const PowerSums sums = power_sums(ways.log_x, shape);
    return 1 / shape + ways.clog_logs / d - sums.power_log / sums.power;
  };
  const auto shapes = bracket(score);
  if (!shapes) return test;
  std::uintmax_t most_steps = 200;
  const auto root = boost::math::tools::toms748_solve(
      score, shapes->first, shapes->second, boost::math::tools::eps_tolerance<double>(), most_steps);
  test.shape = (root.first + root.second) / 2;
  const double scale_power = power_sums(ways.log_x, test.shape).power / d;  // (scale/longest)^shape
  test.scale = ways.longest * std::pow(scale_power, 1 / test.shape);
  test.weibull_likelihood = d * (std::log(test.shape) - std::log(scale_power) - log_longest) +
                            (test.shape - 1) * ways.clog_logs - d;
  test.likelihood_ratio = std::max(0.0, 2 * (test.weibull_likelihood - test.exponential_likelihood));
  test.p_value = cdf(complement(boost::math::chi_squared(1), test.likelihood_ratio));
  return test;
}

std::vector<bool> are_not_exponential(std::span<const WeibullTest> groups) {
  constexpr int fewest_clogs = 10;
  constexpr double significant = 0.05;
  std::vector<double> p_values;
  for (const WeibullTest& group : groups)
    p_values.push_back(group.num_clogs >= fewest_clogs ? group.p_value
                                                       : std::numeric_limits<double>::quiet_NaN());
  std::vector<bool> are_not;
  for (const double p : holm_adjusted(p_values)) are_not.push_back(p < significant);
  return are_not;
}

bool are_mostly_equal(std::vector<double> distances) {
  std::erase_if(distances, [](double distance) { return std::isnan(distance); });
  std::ranges::sort(distances);
  std::size_t num_equal = 0;
  for (std::size_t begin = 0, end = 0; begin < distances.size(); begin = end) {
    while (end < distances.size() && distances[end] == distances[begin]) ++end;
    if (end - begin > 1) num_equal += end - begin;
  }
  return num_equal > 0 && 2 * num_equal >= distances.size();
}

bool are_mostly_at_one_place(std::vector<double> distances) {
  constexpr double share_of_spacing = 0.01;
  constexpr std::size_t fewest = 3;  // two of three or four distances are close by chance in 1 % of cases
  std::erase_if(distances, [](double distance) { return std::isnan(distance); });
  std::ranges::sort(distances);
  const auto number = static_cast<double>(distances.size());
  const double sum = std::accumulate(distances.begin(), distances.end(), 0.0);
  const double widest_gap = share_of_spacing * sum / (number * number);
  std::size_t num_here = 0, most = 0;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    num_here = i > 0 && distances[i] - distances[i - 1] <= widest_gap ? num_here + 1 : 1;
    most = std::max(most, num_here);
  }
  return most >= fewest && 2 * most >= distances.size();
}

}  // namespace clog::fit

#include "clog/fit/clogging_length.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace clog::fit {
namespace {

namespace tools = boost::math::tools;

Interval chi_squared_interval(double total_distance, double degrees_of_freedom, double confidence) {
  const boost::math::chi_squared chi2(degrees_of_freedom);
  const double tail = (1 - confidence) / 2;
  return {2 * total_distance / quantile(complement(chi2, tail)), 2 * total_distance / quantile(chi2, tail)};
}

/// The distance of a run; 0 for a droplet that was pushed back at its release. NaN stays NaN.
double way(const Observation& run) { return run.distance < 0 ? 0 : run.distance; }

/// sqrt(2 (x + exp(-x) - 1)) with the sign of x. For small x the function uses the series, which avoids
/// cancellation.
double signed_root(double x) {
  constexpr double small = 1e-3;  // the next term of the series is x^4/360
  if (std::abs(x) < small) return x * std::sqrt(1 - x / 3 + x * x / 12 - x * x * x / 60);
  return std::copysign(std::sqrt(2 * (x + std::expm1(-x))), x);
}

/// For lambda = u S/d, the log-likelihood is lower than at its maximum by d (log u + 1/u - 1). Twice this
/// difference is d signed_root(log u)^2.
Interval profile_interval(const CloggingLength& fit, double confidence) {
  const double allowed = normal_deviate(confidence) / std::sqrt(static_cast<double>(fit.num_clogs));
  const auto length_at = [&](double root, double from, double to) {
    const auto excess = [=](double log_u) { return signed_root(log_u) - root; };
    std::uintmax_t most_steps = 200;
    const auto [low, high] =
        tools::toms748_solve(excess, from, to, tools::eps_tolerance<double>(), most_steps);
    return fit.length * std::exp((low + high) / 2);
  };
  // These bounds contain the roots: |signed_root(x)| exceeds |x| for x < 0 and is smaller for x > 0; at x = 1
  // + y^2/2 it exceeds y.
  return {length_at(-allowed, -allowed, 0), length_at(allowed, allowed, 1 + allowed * allowed / 2)};
}

}  // namespace

void require_confidence(double confidence) {
  if (!(confidence > 0 && confidence < 1)) throw std::invalid_argument("confidence must lie between 0 and 1");
}

double normal_deviate(double confidence) { return std::numbers::sqrt2 * boost::math::erf_inv(confidence); }

bool all_finite(std::span<const Observation> runs) {
  return std::all_of(runs.begin(), runs.end(),
                     [](const Observation& run) { return std::isfinite(run.distance); });
}

CloggingLength fit_clogging_length(std::span<const Observation> runs, double confidence) {
  require_confidence(confidence);
  CloggingLength fit;
  fit.num_runs = static_cast<int>(runs.size());
  for (const Observation& run : runs) {
    fit.total_distance += way(run);
    fit.num_clogs += run.clogged;
  }
  if (!std::isfinite(fit.total_distance)) {
    constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
    fit.total_distance = fit.length = undefined;
    fit.interval = fit.profile = {undefined, undefined};
    return fit;
  }
  if (fit.num_clogs == 0) {
    fit.length = std::numeric_limits<double>::quiet_NaN();
    fit.interval = {fit.total_distance / -std::log1p(-confidence), std::numeric_limits<double>::infinity()};
    fit.profile = {2 * fit.total_distance / std::pow(normal_deviate(confidence), 2),
                   std::numeric_limits<double>::infinity()};
    return fit;
  }
  fit.length = fit.total_distance / fit.num_clogs;
  const bool is_censored = fit.num_clogs < fit.num_runs;
  fit.interval = chi_squared_interval(fit.total_distance, 2.0 * fit.num_clogs + is_censored, confidence);
  fit.profile = profile_interval(fit, confidence);
  return fit;
}

double relative_half_width(std::int64_t num_clogs, double confidence) {
  if (num_clogs == 0) return std::numeric_limits<double>::infinity();
  const auto d = static_cast<double>(num_clogs);
  const Interval interval = chi_squared_interval(d, 2 * d, confidence);  // relative to an estimate of 1
  return (interval.upper - interval.lower) / 2;
}

double least_squares_length(std::span<const Observation> runs) {
  constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
  if (!all_finite(runs)) return undefined;
  double longest = 0;
  for (const Observation& run : runs) longest = std::max(longest, run.distance);
  std::vector<double> clogs;  // lengths are in units of the longest distance, so nothing overflows
  for (const Observation& run : runs)
    if (run.clogged) clogs.push_back(way(run) / longest);
  if (clogs.size() < 2 || !(longest > 0)) return undefined;
  std::sort(clogs.begin(), clogs.end());
  const auto squares = [&](double log_length) {
    double sum = 0;
    for (std::size_t i = 0; i < clogs.size(); ++i) {
      const double going = 1 - static_cast<double>(i + 1) / static_cast<double>(runs.size());
      sum += std::pow(going - std::exp(-clogs[i] / std::exp(log_length)), 2);
    }
    return sum;
  };
  // Bounds of the fitted length. The upper bound is ten times the length for a single clog, at the longest
  // distance. The lower bound is much smaller than the distance of the first clog.
  const double first = std::max(clogs.front(), 1e-6);
  const double low = std::log(first / (10 * std::log(static_cast<double>(runs.size()) + 2)));
  const double high = std::log(10 * static_cast<double>(runs.size()));
  // The sum may have one or two local minima, so the search begins at the best point of a grid.
  constexpr int num_points = 200;
  const double spacing = (high - low) / num_points;
  double best = low;
  for (int i = 1; i <= num_points; ++i)
    if (const double point = low + i * spacing; squares(point) < squares(best)) best = point;
  constexpr int bits = std::numeric_limits<double>::digits / 2;
  std::uintmax_t most_steps = 200;
  const auto minimum = tools::brent_find_minima(squares, best - spacing, best + spacing, bits, most_steps);
  const double length = longest * std::exp(minimum.first);
  return std::isfinite(length) ? length : undefined;
}

}  // namespace clog::fit

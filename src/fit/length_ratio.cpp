#include "clog/fit/length_ratio.hpp"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <vector>

namespace clog::fit {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
constexpr int fewest_unlike = 10;

/// See fit_clogging_length().
double degrees_of_freedom(const CloggingLength& length) {
  return 2.0 * length.num_clogs + (length.num_clogs < length.num_runs ? 1 : 0);
}

Interval unpaired_interval(double ratio, const CloggingLength& here, const CloggingLength& there,
                           double confidence) {
  const boost::math::fisher_f f(degrees_of_freedom(here), degrees_of_freedom(there));
  const double tail = (1 - confidence) / 2;
  return {ratio / quantile(complement(f, tail)), ratio / quantile(f, tail)};
}

/// Sums over pairs, from which the sums without one of the pairs are computed.
struct Sums {
  double way_here = 0, way_there = 0;
  double clogs_here = 0, clogs_there = 0;

  void add(const Pair& pair, double times) {
    way_here += times * std::max(pair.here.distance, 0.0);
    way_there += times * std::max(pair.there.distance, 0.0);
    clogs_here += times * pair.here.clogged;
    clogs_there += times * pair.there.clogged;
  }
  double log_here() const { return std::log(way_here / clogs_here); }
  double log_there() const { return std::log(way_there / clogs_there); }
};

/// Mean square errors (variances and covariance) from the jackknife estimates.
struct Scatter {
  double here = 0, there = 0, both = 0;

  double of_ratio() const { return here + there - 2 * both; }
};

Scatter scatter_of(std::span<const Pair> pairs, const Sums& all) {
  std::vector<double> here, there;
  for (const Pair& pair : pairs) {
    Sums rest = all;
    rest.add(pair, -1);
    here.push_back(rest.log_here());
    there.push_back(rest.log_there());
  }
  const auto size = static_cast<double>(pairs.size());
  double mean_here = 0, mean_there = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    mean_here += here[i] / size;
    mean_there += there[i] / size;
  }
  Scatter scatter;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double a = here[i] - mean_here, b = there[i] - mean_there;
    scatter.here += a * a;
    scatter.there += b * b;
    scatter.both += a * b;
  }
  for (double* one : {&scatter.here, &scatter.there, &scatter.both}) *one *= (size - 1) / size;
  return scatter;
}

/// Whether a correlation over this number of pairs is positive at a significance level of 2.5 %.
bool is_positive(double correlation, double num_pairs) {
  constexpr double error = 0.025;
  const double t = correlation * std::sqrt((num_pairs - 2) / std::max(1 - correlation * correlation, 1e-12));
  return t > quantile(complement(boost::math::students_t(num_pairs - 2), error));
}

void add_pairs(std::span<const Pair> pairs, double confidence, LengthRatio& fit) {
  fit.num_pairs = static_cast<int>(pairs.size());
  fit.num_unlike = static_cast<int>(std::ranges::count(pairs, false, &Pair::is_alike));
  fit.paired = {not_known, not_known};
  fit.paired_ratio = fit.correlation = fit.gain = not_known;
  Sums all;
  for (const Pair& pair : pairs) all.add(pair, 1);
  constexpr std::size_t fewest_pairs = 3;
  if (pairs.size() < fewest_pairs || all.clogs_here < 2 || all.clogs_there < 2) return;
  const Scatter scatter = scatter_of(pairs, all);
  fit.paired_ratio = std::exp(all.log_here() - all.log_there());
  fit.correlation = scatter.both / std::sqrt(scatter.here * scatter.there);
  fit.gain = std::sqrt((scatter.here + scatter.there) / scatter.of_ratio());
  const auto size = static_cast<double>(pairs.size());
  const double t = quantile(complement(boost::math::students_t(size - 1), (1 - confidence) / 2));
  const double side = t * std::sqrt(std::max(scatter.of_ratio(), 0.0));
  fit.paired = {fit.paired_ratio * std::exp(-side), fit.paired_ratio * std::exp(side)};
}

}  // namespace

LengthRatio fit_length_ratio(std::span<const Observation> here, std::span<const Observation> there,
                             std::span<const Pair> pairs, double confidence) {
  const CloggingLength length_here = fit_clogging_length(here, confidence);
  const CloggingLength length_there = fit_clogging_length(there, confidence);
  LengthRatio fit;
  add_pairs(pairs, confidence, fit);
  fit.ratio = length_here.length / length_there.length;
  fit.interval = fit.unpaired = {not_known, not_known};
  if (length_here.num_clogs == 0 || length_there.num_clogs == 0 || !std::isfinite(fit.ratio)) return fit;
  fit.interval = fit.unpaired = unpaired_interval(fit.ratio, length_here, length_there, confidence);
  fit.is_paired = fit.num_unlike >= fewest_unlike && std::isfinite(fit.correlation) &&
                  is_positive(fit.correlation, fit.num_pairs);
  if (!fit.is_paired) return fit;
  fit.ratio = fit.paired_ratio;
  fit.interval = fit.paired;
  return fit;
}

}  // namespace clog::fit

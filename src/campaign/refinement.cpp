#include "clog/campaign/refinement.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "clog/core/tools/number_text.hpp"
#include "clog/fit/clogging_length.hpp"
#include "clog/fit/curve_features.hpp"
#include "confidence.hpp"

namespace clog::campaign {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Kind = RefinementGoal::Kind;

/// How much each place of the curve matters. A little of it is spread over all, so that none is forgotten.
VectorXd weights_of(const fit::Curve& curve, const RefinementGoal& goal) {
  constexpr double spread = 0.1;
  VectorXd even = VectorXd::Constant(curve.mean.size(), 1.0 / static_cast<double>(curve.mean.size()));
  VectorXd special;
  if (goal.kind == Kind::peak) special = fit::peak_probabilities(curve);
  if (goal.kind == Kind::crossing) {
    const Eigen::ArrayXd deviation = curve.deviation().array().max(std::numeric_limits<double>::min());
    const Eigen::ArrayXd apart = (curve.mean.array() - std::log(goal.length)) / deviation;
    special = (-0.5 * apart.square()).exp() / deviation;
  }
  if (special.size() == 0 || !(special.sum() > 0)) return even;
  return spread * even + (1 - spread) * special / special.sum();
}

double half_width(double lower, double upper) { return std::sinh((upper - lower) / 2); }

}  // namespace

std::string RefinementGoal::text() const {
  const std::string percent = shortest(100 * precision) + "%";
  switch (kind) {
    case Kind::curve:
      return "curve=" + percent;
    case Kind::peak:
      return "peak=" + percent;
    case Kind::crossing:
      return fmt::format("crossing={}:{}", shortest(length), percent);
    case Kind::none:
      break;
  }
  return "";
}

std::vector<ExpectedRun> expected_runs(std::span<const RefinedPoint> points,
                                       const RefinementCandidates& candidates, const VectorXd& log_length) {
  Eigen::Array2d low = candidates.places.front();
  Eigen::Array2d high = low;
  for (const fit::CurvePlace& place : candidates.places) {
    low = low.min(place.array());
    high = high.max(place.array());
  }
  const Eigen::Array2d range = (high - low).max(std::numeric_limits<double>::min());
  constexpr double nearness = 1e-3;  // of the range, squared: what is nearer counts alike
  std::vector<ExpectedRun> runs;
  for (std::size_t i = 0; i < candidates.places.size(); ++i) {
    // Speed and work per time are those of the points nearby.
    double distance = 0;
    double time = 0;
    double work = 0;
    for (const RefinedPoint& point : points) {
      const double apart = ((point.place - candidates.places[i]).array() / range).square().sum();
      const double weight = 1 / (point.time * (nearness + apart) * (nearness + apart));
      distance += weight * point.distance;
      time += weight * point.time;
      work += weight * point.work;
    }
    const double longest = candidates.max_time * distance / time;
    const double length = std::exp(log_length[static_cast<Index>(i)]);
    const double num_clogs = -std::expm1(-longest / length);
    const double way = std::min(length * num_clogs, longest);
    runs.push_back({num_clogs, way * work / distance});
  }
  return runs;
}

double known_precision(const fit::Curve& curve, std::span<const fit::CurvePlace> places,
                       const RefinementGoal& goal) {
  if (goal.kind == Kind::curve) {
    const double mean_square = curve.covariance.diagonal().cwiseMax(0).mean();
    return std::sinh(fit::normal_deviate(default_confidence) * std::sqrt(mean_square));
  }
  if (goal.kind == Kind::peak) {
    const fit::CurvePeak peak = fit::find_peak(curve, places, default_confidence);
    return std::max(half_width(peak.place_lower[0], peak.place_upper[0]),
                    half_width(peak.place_lower[1], peak.place_upper[1]));
  }
  if (goal.kind == Kind::crossing) {
    double widest = 0;
    for (const fit::CurveCrossing& one : fit::find_crossings(curve, places, goal.length, default_confidence))
      widest = std::max(widest, half_width(one.interval.lower, one.interval.upper));
    if (widest > 0) return widest;
  }
  return std::numeric_limits<double>::infinity();  // nothing is known
}

std::vector<std::int64_t> choose_blocks(const fit::Curve& curve, std::span<const ExpectedRun> runs,
                                        const RefinementGoal& goal, RoundLimits limits) {
  fit::Curve expected = curve;
  const VectorXd weights = weights_of(curve, goal);
  const auto block = static_cast<double>(limits.seeds_per_block);
  std::vector<std::int64_t> blocks(runs.size(), 0);
  double work = 0;
  while (true) {
    std::size_t best = runs.size();
    double best_gain = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (blocks[i] >= limits.blocks_left[i] || work + block * runs[i].work > limits.most_work) continue;
      const VectorXd fall =
          fit::covariance_update(expected, static_cast<Index>(i), block * runs[i].num_clogs);
      const double gain = weights.dot(fall.cwiseAbs2()) / (block * runs[i].work);
      if (!(gain > best_gain)) continue;
      best = i;
      best_gain = gain;
    }
    if (best == runs.size()) return blocks;
    const double cost = block * runs[best].work;
    if (work > 0 && work + cost > limits.work) return blocks;
    fit::take_as_done(expected, static_cast<Index>(best), block * runs[best].num_clogs);
    ++blocks[best];
    work += cost;
  }
}

}  // namespace clog::campaign

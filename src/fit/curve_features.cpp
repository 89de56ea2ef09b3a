#include "clog/fit/curve_features.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

namespace clog::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int num_draws = 2000;

/// The same numbers with every library, unlike std::normal_distribution.
double normal_number(std::mt19937_64& engine) {
  constexpr double bits = 9007199254740992.0;  // 2^53
  const double between_0_and_1 = (static_cast<double>(engine() >> 11U) + 0.5) / bits;
  return std::numbers::sqrt2 * boost::math::erf_inv(2 * between_0_and_1 - 1);
}

Interval quantiles(std::vector<double> numbers, double confidence) {
  std::ranges::sort(numbers);
  const auto at = [&](double share) {
    const double index = share * static_cast<double>(numbers.size() - 1);
    const auto below = static_cast<std::size_t>(index);
    const std::size_t above = std::min(below + 1, numbers.size() - 1);
    return numbers[below] + (index - static_cast<double>(below)) * (numbers[above] - numbers[below]);
  };
  const double tail = (1 - confidence) / 2;
  return {at(tail), at(1 - tail)};
}

/// The highest point of a parabola through the highest place of a line and its neighbours.
struct Top {
  CurvePlace place;
  double height;
  bool is_inside;
};

bool is_line(std::span<const CurvePlace> places) {
  return std::ranges::all_of(places, [&](const CurvePlace& place) { return place[1] == places.front()[1]; });
}

Top top_of_line(const VectorXd& heights, std::span<const CurvePlace> places) {
  Index highest = 0;
  heights.maxCoeff(&highest);
  const CurvePlace here = places[static_cast<std::size_t>(highest)];
  const double height = heights[highest];
  if (highest == 0 || highest == heights.size() - 1) return {here, height, false};
  const double left = places[static_cast<std::size_t>(highest - 1)][0] - here[0];
  const double right = places[static_cast<std::size_t>(highest + 1)][0] - here[0];
  const double slope_left = (heights[highest - 1] - height) / left;
  const double slope_right = (heights[highest + 1] - height) / right;
  const double curvature = (slope_right - slope_left) / (right - left);
  if (!(curvature < 0)) return {here, height, true};
  const double slope = slope_left - curvature * left;
  const double shift = std::clamp(-slope / (2 * curvature), left / 2, right / 2);
  return {{here[0] + shift, here[1]}, height + slope * shift + curvature * shift * shift, true};
}

struct Borders {
  Eigen::Array2d low;
  Eigen::Array2d high;
};

Top top_of_grid(const VectorXd& heights, std::span<const CurvePlace> places, const Borders& borders) {
  Index highest = 0;
  heights.maxCoeff(&highest);
  const CurvePlace& place = places[static_cast<std::size_t>(highest)];
  const bool is_inside = (place.array() > borders.low).all() && (place.array() < borders.high).all();
  return {place, heights[highest], is_inside};
}

}  // namespace

std::vector<CurveValue> curve_values(const Curve& curve, double confidence) {
  require_confidence(confidence);
  const double z = normal_deviate(confidence);
  const VectorXd deviation = curve.deviation();
  std::vector<CurveValue> values;
  for (Index i = 0; i < curve.mean.size(); ++i)
    values.push_back(
        {std::exp(curve.mean[i]),
         {std::exp(curve.mean[i] - z * deviation[i]), std::exp(curve.mean[i] + z * deviation[i])}});
  return values;
}

MatrixXd drawn_curves(const Curve& curve, int num_curves) {
  constexpr double first_jitter = 1e-10;
  const Index size = curve.mean.size();
  const double scale = std::max(curve.covariance.diagonal().maxCoeff(), std::numeric_limits<double>::min());
  Eigen::LLT<MatrixXd> factor;
  for (double jitter = first_jitter; jitter < 1; jitter *= 10) {
    factor.compute(curve.covariance + jitter * scale * MatrixXd::Identity(size, size));
    if (factor.info() == Eigen::Success) break;
  }
  constexpr std::uint64_t seed = 1;
  std::mt19937_64 engine(seed);
  MatrixXd numbers(size, num_curves);
  for (double& number : numbers.reshaped()) number = normal_number(engine);
  MatrixXd draws = factor.matrixL() * numbers;
  draws.colwise() += curve.mean;
  return draws;
}

CurvePeak find_peak(const Curve& curve, std::span<const CurvePlace> places, double confidence) {
  require_confidence(confidence);
  Borders borders{places.front(), places.front()};
  for (const CurvePlace& place : places) {
    borders.low = borders.low.min(place.array());
    borders.high = borders.high.max(place.array());
  }
  const bool is_one_key = is_line(places);
  const auto top_of = [&](const VectorXd& heights) {
    return is_one_key ? top_of_line(heights, places) : top_of_grid(heights, places, borders);
  };
  std::vector<double> first;
  std::vector<double> second;
  std::vector<double> heights;
  int num_inside = 0;
  const MatrixXd draws = drawn_curves(curve, num_draws);
  for (Index i = 0; i < draws.cols(); ++i) {
    const Top top = top_of(draws.col(i));
    first.push_back(top.place[0]);
    second.push_back(top.place[1]);
    heights.push_back(top.height);
    num_inside += top.is_inside;
  }
  const Top top = top_of(curve.mean);
  const Interval of_first = quantiles(first, confidence);
  const Interval of_second = quantiles(second, confidence);
  const Interval of_height = quantiles(heights, confidence);
  return {.place = top.place,
          .place_lower = {of_first.lower, of_second.lower},
          .place_upper = {of_first.upper, of_second.upper},
          .length = std::exp(top.height),
          .interval = {std::exp(of_height.lower), std::exp(of_height.upper)},
          .share_inside = static_cast<double>(num_inside) / num_draws};
}

VectorXd peak_probabilities(const Curve& curve) {
  VectorXd shares = VectorXd::Zero(curve.mean.size());
  const MatrixXd draws = drawn_curves(curve, num_draws);
  for (Index i = 0; i < draws.cols(); ++i) {
    Index highest = 0;
    draws.col(i).maxCoeff(&highest);
    shares[highest] += 1.0 / num_draws;
  }
  return shares;
}

std::vector<CurveCrossing> find_crossings(const Curve& curve, std::span<const CurvePlace> places,
                                          double length, double confidence) {
  require_confidence(confidence);
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const double z = normal_deviate(confidence);
  const VectorXd above = curve.mean.array() - std::log(length);
  const VectorXd band = z * curve.deviation();
  const Index size = above.size();
  // Between two places what is given at each is a straight line.
  const auto zero_between = [&](Index i, Index j, double at_i, double at_j) {
    const double from = places[static_cast<std::size_t>(i)][0];
    const double to = places[static_cast<std::size_t>(j)][0];
    return from + (to - from) * at_i / (at_i - at_j);
  };
  const auto end_of_band = [&](Index start, Index step, double side) {
    const auto inside = [&](Index i) { return side * above[i] + band[i]; };  // positive: the band holds it
    for (Index i = start; i + step >= 0 && i + step < size; i += step)
      if (inside(i + step) < 0)
        return inside(i) < 0 ? places[static_cast<std::size_t>(i)][0]
                             : zero_between(i, i + step, inside(i), inside(i + step));
    return static_cast<double>(step) * infinite;
  };
  std::vector<CurveCrossing> crossings;
  for (Index i = 0; i + 1 < size; ++i) {
    const bool is_upward = above[i] < 0 && above[i + 1] >= 0;
    if (!is_upward && !(above[i] >= 0 && above[i + 1] < 0)) continue;
    const double side = is_upward ? 1 : -1;
    crossings.push_back({zero_between(i, i + 1, above[i], above[i + 1]),
                         {end_of_band(i + 1, -1, side), end_of_band(i, 1, -side)},
                         is_upward});
  }
  return crossings;
}

}  // namespace clog::fit

#include "clog/fit/fitted_curve.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace clog::fit {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double variance_of_level =
    100;                         // of the process's mean about the points' common log lambda: a factor e^10
constexpr double jitter = 1e-8;  // of the variance, so that rounding leaves kernels positive definite

/// Matern's correlation with smoothness 5/2 at a distance in units of the correlation length.
double matern(double distance) {
  const double x = std::sqrt(5.0) * std::abs(distance);
  return (1 + x + x * x / 3) * std::exp(-x);
}

double kernel(const CurvePlace& a, const CurvePlace& b, const CurveScales& scales) {
  const Eigen::Array2d apart = (a - b).array() / scales.lengths;
  return scales.amplitude * scales.amplitude * matern(apart[0]) * matern(apart[1]) + variance_of_level;
}

template <class PlaceOfRow, class PlaceOfColumn>
MatrixXd kernels(Index rows, const PlaceOfRow& row, Index columns, const PlaceOfColumn& column,
                 const CurveScales& scales) {
  MatrixXd matrix(rows, columns);
  for (Index j = 0; j < columns; ++j)
    for (Index i = 0; i < rows; ++i) matrix(i, j) = kernel(row(i), column(j), scales);
  return matrix;
}

/// The points as arrays, ways in units of the common clogging length, so that log lambda is about zero.
struct Data {
  std::span<const CurvePoint> points;
  ArrayXd clogs;
  ArrayXd distances;
  double level;  ///< logarithm of the common clogging length

  explicit Data(std::span<const CurvePoint> all)
      : points(all), clogs(static_cast<Index>(all.size())), distances(clogs.size()) {
    if (all.empty()) throw std::invalid_argument("a curve needs a point");
    for (Index i = 0; i < size(); ++i) {
      const CurvePoint& point = all[static_cast<std::size_t>(i)];
      if (!(point.distance > 0) || !std::isfinite(point.distance) || !(point.num_clogs >= 0) ||
          !point.place.allFinite())
        throw std::invalid_argument("a point of a curve needs a finite place and a positive, finite way");
      clogs[i] = point.num_clogs;
      distances[i] = point.distance;
    }
    constexpr double half_a_clog = 0.5;  // where there is none at all
    level = std::log(distances.sum() / std::max(clogs.sum(), half_a_clog));
    distances *= std::exp(-level);
  }
  Index size() const { return clogs.size(); }
  CurvePlace place(Index i) const { return points[static_cast<std::size_t>(i)].place; }

  double log_likelihood(const ArrayXd& f) const { return (-clogs * f - distances * (-f).exp()).sum(); }
};

/// The maximum of the posterior, and its curvature there.
struct Mode {
  VectorXd slopes;                ///< of the log likelihood: K^-1 f
  ArrayXd roots;                  ///< of the expected clogs W = S exp(-f), the likelihood's curvature
  Eigen::LLT<MatrixXd> factor{};  ///< of B = 1 + W^1/2 K W^1/2
  double log_evidence = 0;
};

/// Newton's steps for a concave function, halved where they lead too far.
Mode find_mode(const Data& data, const MatrixXd& covariance) {
  constexpr int most_steps = 200;
  constexpr int most_halvings = 40;
  constexpr double settled = 1e-10;
  Mode mode;
  VectorXd a = VectorXd::Zero(data.size());
  VectorXd f = a;
  const auto height = [&](const VectorXd& slopes, const VectorXd& at) {
    return data.log_likelihood(at.array()) - slopes.dot(at) / 2;
  };
  double best = height(a, f);
  for (int step = 0; step < most_steps; ++step) {
    const ArrayXd expected = data.distances * (-f.array()).exp();
    mode.roots = expected.sqrt();
    mode.factor.compute(MatrixXd::Identity(data.size(), data.size()) +
                        mode.roots.matrix().asDiagonal() * covariance * mode.roots.matrix().asDiagonal());
    const VectorXd b = expected * f.array() + (expected - data.clogs);
    const VectorXd solved = mode.factor.solve((mode.roots * (covariance * b).array()).matrix());
    const VectorXd way = b - (mode.roots * solved.array()).matrix() - a;
    double share = 1;
    double found = -1;
    for (int i = 0; i < most_halvings; ++i, share /= 2) {
      const VectorXd slopes = a + share * way;
      const VectorXd at = covariance * slopes;
      found = height(slopes, at);
      if (!(found >= best)) continue;
      a = slopes;
      f = at;
      break;
    }
    const double gain = found - best;
    if (!(gain > 0)) break;
    best = found;
    if (gain < settled) break;
  }
  const ArrayXd expected = data.distances * (-f.array()).exp();
  mode.roots = expected.sqrt();
  mode.factor.compute(MatrixXd::Identity(data.size(), data.size()) +
                      mode.roots.matrix().asDiagonal() * covariance * mode.roots.matrix().asDiagonal());
  mode.slopes = a;
  mode.log_evidence = best - mode.factor.matrixLLT().diagonal().array().log().sum();
  return mode;
}

struct ModeOfScales {
  CurveScales scales;
  Mode mode;
};

ModeOfScales mode_of(const Data& data, const CurveScales& scales) {
  const auto point = [&](Index i) { return data.place(i); };
  MatrixXd covariance = kernels(data.size(), point, data.size(), point, scales);
  covariance.diagonal().array() += jitter * scales.amplitude * scales.amplitude;
  return {scales, find_mode(data, covariance)};
}

Curve curve_at(const Data& data, const ModeOfScales& found, std::span<const CurvePlace> places) {
  const auto point = [&](Index i) { return data.place(i); };
  const auto place = [&](Index i) { return places[static_cast<std::size_t>(i)]; };
  const auto size = static_cast<Index>(places.size());
  const MatrixXd across = kernels(data.size(), point, size, place, found.scales);
  const MatrixXd known =
      found.mode.factor.matrixL().solve(MatrixXd(found.mode.roots.matrix().asDiagonal() * across));
  Curve curve;
  curve.mean = (across.transpose() * found.mode.slopes).array() + data.level;
  curve.covariance = kernels(size, place, size, place, found.scales);
  curve.covariance.noalias() -= known.transpose() * known;
  curve.log_evidence = found.mode.log_evidence;
  return curve;
}

/// Amplitudes and lengths, evenly on a logarithmic scale. A key of which there is one value has no length.
std::vector<CurveScales> all_scales(std::span<const CurvePlace> places) {
  constexpr double amplitudes[] = {0.25, 0.5, 1, 2, 4, 8};
  constexpr double shares_of_range[] = {0.1, 0.16, 0.25, 0.4, 0.63, 1, 1.6, 3};
  Eigen::Array2d low = places.front();
  Eigen::Array2d high = low;
  for (const CurvePlace& place : places) {
    low = low.min(place.array());
    high = high.max(place.array());
  }
  std::vector<double> lengths[2];
  for (const int key : {0, 1}) {
    const double range = high[key] - low[key];
    if (!(range > 0)) lengths[key] = {1};
    if (range > 0)
      for (const double share : shares_of_range) lengths[key].push_back(share * range);
  }
  std::vector<CurveScales> scales;
  for (const double amplitude : amplitudes)
    for (const double first : lengths[0])
      for (const double second : lengths[1]) scales.push_back({amplitude, {first, second}});
  return scales;
}

}  // namespace

Curve curve_of_scales(std::span<const CurvePoint> points, const CurveScales& scales,
                      std::span<const CurvePlace> places) {
  const Data data(points);
  return curve_at(data, mode_of(data, scales), places);
}

Curve fit_curve(std::span<const CurvePoint> points, std::span<const CurvePlace> places) {
  const Data data(points);
  std::vector<CurvePlace> all(places.begin(), places.end());
  for (const CurvePoint& point : points) all.push_back(point.place);
  std::vector<ModeOfScales> modes;
  for (const CurveScales& scales : all_scales(all)) modes.push_back(mode_of(data, scales));
  std::ranges::sort(modes, [](const ModeOfScales& a, const ModeOfScales& b) {
    return a.mode.log_evidence > b.mode.log_evidence;
  });
  const double best = modes.front().mode.log_evidence;
  double sum = 0;
  for (const ModeOfScales& one : modes) sum += std::exp(one.mode.log_evidence - best);

  constexpr double enough = 0.98;  // of the weight; the least likely scales change nothing
  const auto size = static_cast<Index>(places.size());
  Curve mixture{VectorXd::Zero(size), MatrixXd::Zero(size, size), best + std::log(sum)};
  double weight_so_far = 0;
  for (const ModeOfScales& one : modes) {
    if (weight_so_far >= enough) break;
    const double weight = std::exp(one.mode.log_evidence - best) / sum;
    const Curve curve = curve_at(data, one, places);
    mixture.mean += weight * curve.mean;
    mixture.covariance += weight * (curve.covariance + curve.mean * curve.mean.transpose());
    weight_so_far += weight;
  }
  mixture.mean /= weight_so_far;
  mixture.covariance = mixture.covariance / weight_so_far - mixture.mean * mixture.mean.transpose();
  return mixture;
}

VectorXd covariance_update(const Curve& curve, Index place_index, double num_clogs) {
  const double variance = std::max(curve.covariance(place_index, place_index), 0.0);
  return curve.covariance.col(place_index) * std::sqrt(num_clogs / (1 + num_clogs * variance));
}

void take_as_done(Curve& curve, Index place_index, double num_clogs) {
  const VectorXd update = covariance_update(curve, place_index, num_clogs);
  curve.covariance.noalias() -= update * update.transpose();
}

}  // namespace clog::fit

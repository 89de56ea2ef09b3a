#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

/// A smooth curve through clogging lengths: lambda as a function of one or two keys.
///
/// Runs that travelled the distance S in all and clogged d times are a Poisson count d with exposure S: with
/// f = log lambda, log L = -d f - S exp(-f), which is concave in f (Lawless, Statistical Models and Methods
/// for Lifetime Data, ch. 4). f itself is a Gaussian process over the logarithms of the keys, its kernel a
/// product of Matern kernels with smoothness 5/2. Its posterior is Laplace's approximation (Rasmussen and
/// Williams, Gaussian Processes for Machine Learning, algorithms 3.1, 3.2), averaged over amplitudes and
/// correlation lengths by the marginal likelihood.
namespace clog::fit {

/// A place of the curve: logarithms of the keys; the second is 0 where there is one key.
using CurvePlace = Eigen::Vector2d;

/// The sums over all runs at one place. Points without a clog are bounds, and inform the curve as such.
struct CurvePoint {
  CurvePlace place;
  double num_clogs;
  double distance;  ///< S, of all runs together [sigma]
};

/// The process's scales: standard deviation of log lambda, correlation length of each key's logarithm.
struct CurveScales {
  double amplitude;
  Eigen::Array2d lengths;
};

/// Normal distribution of log lambda at some places.
struct Curve {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
  double log_evidence = 0;  ///< logarithm of the marginal likelihood, up to a constant of the points

  /// Standard deviation at each place.
  Eigen::VectorXd deviation() const { return covariance.diagonal().cwiseMax(0).cwiseSqrt(); }
};

/// The curve for known scales. @throws std::invalid_argument unless there is a point, and every point has a
/// finite place, a positive, finite distance, and no negative number of clogs
Curve curve_of_scales(std::span<const CurvePoint> points, const CurveScales& scales,
                      std::span<const CurvePlace> places);

/// The curve, averaged over the scales. Beforehand, all amplitudes from a factor of 1.3 to one of 3000 are
/// equally likely, and correlation lengths from a tenth of the range of places to three times that.
/// @throws std::invalid_argument as curve_of_scales()
Curve fit_curve(std::span<const CurvePoint> points, std::span<const CurvePlace> places);

/// The vector u of the rank-one update, covariance - u u^T, by `num_clogs` more clogs at a place: the squares
/// of its entries are the reductions of the variance at all places. u is the covariance with that place,
/// times sqrt(num_clogs / (1 + num_clogs variance)).
/// @param place_index  of a place of the curve
Eigen::VectorXd covariance_update(const Curve& curve, Eigen::Index place_index, double num_clogs);
/// Updates the covariance as if these clogs had been observed. The mean stays: the results are not known yet.
void take_as_done(Curve& curve, Eigen::Index place_index, double num_clogs);

}  // namespace clog::fit

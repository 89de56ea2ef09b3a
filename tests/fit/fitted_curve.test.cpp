#include "clog/fit/fitted_curve.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "clog/fit/clogging_length.hpp"

namespace clog::fit {
namespace {

std::vector<CurvePlace> line(std::initializer_list<double> values) {
  std::vector<CurvePlace> places;
  for (const double value : values) places.emplace_back(std::log(value), 0);
  return places;
}

/// A peak in line tension, with a point at which nothing clogged.
std::vector<CurvePoint> peaked_points() {
  const std::vector<CurvePlace> places = line({0.03, 0.06, 0.12, 0.25, 0.5, 1, 2, 3});
  const double clogs[] = {12, 9, 11, 6, 3, 0, 4, 10};
  const double distances[] = {14.2, 31, 150, 410, 1500, 2400, 520, 260};
  std::vector<CurvePoint> points;
  for (std::size_t i = 0; i < places.size(); ++i) points.push_back({places[i], clogs[i], distances[i]});
  return points;
}

/// Numbers of R 4.2.2 with mgcv 1.8-41 (Debian's r-cran-mgcv), made by
///
///     library(mgcv)
///     gamma <- c(0.03, 0.06, 0.12, 0.25, 0.5, 1, 2, 3, 0.1, 0.4, 1.5)   # the last three: places without
///     runs d <- c(12, 9, 11, 6, 3, 0, 4, 10, 0, 0, 0) S <- c(14.2, 31, 150, 410, 1500, 2400, 520, 260,
///     1e-12, 1e-12, 1e-12) x <- log(gamma); r <- sqrt(5) * abs(outer(x, x, "-")) / 1.5 K <- 2^2 * (1 + r +
///     r^2 / 3) * exp(-r) + 100 level <- log(sum(S) / sum(d)); X <- diag(length(x)) m <- gam(d ~ X - 1 +
///     offset(log(S) - level), family = poisson,
///              paraPen = list(X = list(solve(K), sp = 1)),
///              control = gam.control(epsilon = 1e-12, scalePenalty = FALSE))
///     print(unname(level - coef(m)), digits = 10); print(unname(sqrt(diag(vcov(m)))), digits = 10)
TEST(FittedCurve, AgreesWithThePoissonRegressionOfMgcv) {
  const double means[] = {0.2441181554, 1.2123775185, 2.5948002823, 4.3099332827, 6.2666506941, 6.9366452329,
                          4.8875505137, 3.3828967719, 2.2209269217, 5.6607038001, 5.9702412443};
  const double errors[] = {0.2877718658, 0.2843265923, 0.2661788591, 0.3519642672, 0.4396899634, 0.4702012490,
                           0.3508359344, 0.3107053632, 0.2717361962, 0.4169852842, 0.4312045876};
  const Curve curve = curve_of_scales(peaked_points(), {2, {1.5, 1}},
                                      line({0.03, 0.06, 0.12, 0.25, 0.5, 1, 2, 3, 0.1, 0.4, 1.5}));
  const Eigen::VectorXd deviation = curve.deviation();
  for (Eigen::Index i = 0; i < 11; ++i) {
    constexpr double tolerance = 1e-6;  // of the jitter on the kernel's diagonal
    EXPECT_NEAR(curve.mean[i], means[i], tolerance);
    EXPECT_NEAR(deviation[i], errors[i], tolerance);
  }
}

TEST(FittedCurve, IsTheOrdinaryLengthWhereOnePointHasManyClogs) {
  const std::vector<CurvePoint> one = {{{0, 0}, 400, 2000}};
  const Curve curve = fit_curve(one, line({1}));
  EXPECT_NEAR(curve.mean[0], std::log(5.0), 1e-3);
  EXPECT_NEAR(curve.deviation()[0], 1 / std::sqrt(400.0), 1e-3);
}

TEST(FittedCurve, IsPushedUpByALongerWayWithoutAClog) {
  std::vector<CurvePoint> points = peaked_points();
  const std::vector<CurvePlace> there = line({1});
  const double before = fit_curve(points, there).mean[0];
  points[5].distance *= 10;
  EXPECT_GT(fit_curve(points, there).mean[0], before + 0.3);
}

TEST(FittedCurve, IsLinearInTheUnitOfLength) {
  std::vector<CurvePoint> points = peaked_points();
  const std::vector<CurvePlace> places = line({0.03, 0.3, 3});
  const Curve before = fit_curve(points, places);
  for (CurvePoint& point : points) point.distance *= 1e6;
  const Curve after = fit_curve(points, places);
  EXPECT_LT((after.mean.array() - before.mean.array() - std::log(1e6)).abs().maxCoeff(), 1e-6);
  EXPECT_LT((after.covariance - before.covariance).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(FittedCurve, TakesTwoKeys) {
  std::vector<CurvePoint> points;
  for (const double first : {0.0, 1.0, 2.0})
    for (const double second : {0.0, 1.0, 2.0})
      points.push_back({{first, second}, 100, 100 * std::exp(1 + first - 0.5 * second)});
  const Curve curve = fit_curve(points, std::vector<CurvePlace>{{0.5, 0.5}, {1.5, 1.0}});
  EXPECT_NEAR(curve.mean[0], 1.25, 0.15);
  EXPECT_NEAR(curve.mean[1], 2.0, 0.15);
}

TEST(FittedCurve, KnowsBeforehandWhatMoreClogsWillDoToTheVariance) {
  const std::vector<CurvePlace> places = line({0.03, 0.1, 0.3, 1, 3});
  Curve curve = curve_of_scales(peaked_points(), {2, {1.5, 1}}, places);
  Eigen::MatrixXd precision = curve.covariance.inverse();
  precision(2, 2) += 7;  // seven clogs, each one of information
  const Eigen::MatrixXd expected = precision.inverse();
  const Eigen::VectorXd before = curve.covariance.diagonal();
  const Eigen::VectorXd fall = covariance_update(curve, 2, 7);
  take_as_done(curve, 2, 7);
  EXPECT_LT((curve.covariance - expected).cwiseAbs().maxCoeff(), 1e-7);
  EXPECT_LT((before - fall.cwiseAbs2() - expected.diagonal()).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(FittedCurve, HasABandThatHoldsTheTruthAboutAsOftenAsItSays) {
  constexpr int num_repetitions = 40;  // the study in tests/refinement has 200, and other truths
  std::mt19937_64 engine(1);
  const std::vector<CurvePlace> places = line({0.03, 0.05, 0.1, 0.2, 0.4, 0.7, 1.5, 3});
  const auto truth = [](double place) { return 5 * std::exp(-std::pow((place + 0.7) / 1.2, 2) / 2); };
  int num_held = 0;
  for (int repetition = 0; repetition < num_repetitions; ++repetition) {
    std::vector<CurvePoint> points;
    for (const CurvePlace& place : line({0.03, 0.06, 0.12, 0.25, 0.5, 1, 1.7, 3})) {
      std::exponential_distribution<double> distances(std::exp(-truth(place[0])));
      CurvePoint& point = points.emplace_back(CurvePoint{place, 0, 0});
      for (int run = 0; run < 10; ++run) {
        constexpr double longest = 100;
        const double distance = distances(engine);
        point.num_clogs += distance < longest;
        point.distance += std::min(distance, longest);
      }
    }
    const Curve curve = fit_curve(points, places);
    for (Eigen::Index i = 0; i < curve.mean.size(); ++i)
      num_held += std::abs(curve.mean[i] - truth(places[static_cast<std::size_t>(i)][0])) <
                  normal_deviate(0.95) * curve.deviation()[i];
  }
  const double share = static_cast<double>(num_held) / (num_repetitions * static_cast<int>(places.size()));
  EXPECT_GT(share, 0.92);
  EXPECT_LT(share, 0.99);
}

TEST(FittedCurve, RefusesWhatIsNoNumber) {
  const std::vector<CurvePlace> places = line({1});
  const double undefined = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(fit_curve({}, places), std::invalid_argument);
  EXPECT_THROW(fit_curve(std::vector<CurvePoint>{{{0, 0}, 1, 0}}, places), std::invalid_argument);
  EXPECT_THROW(fit_curve(std::vector<CurvePoint>{{{0, 0}, 1, undefined}}, places), std::invalid_argument);
  EXPECT_THROW(fit_curve(std::vector<CurvePoint>{{{undefined, 0}, 1, 1}}, places), std::invalid_argument);
}

}  // namespace
}  // namespace clog::fit

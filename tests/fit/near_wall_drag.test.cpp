#include "clog/fit/near_wall_drag.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace clog::fit {
namespace {

/// v_g/v_t from v_t/v_g - 1 = b_0/b_inf d^-alpha.
double speed_at(double distance, double drag, double exponent) {
  return 1 / (1 + drag * std::pow(distance, -exponent));
}

TEST(NearWallDrag, FindsTheLawThatMadeTheSpeeds) {
  std::vector<NearWallSpeed> speeds;
  for (const double d : {0.03, 0.1, 0.5, 2.0}) speeds.push_back({d, speed_at(d, 0.07, 4.0 / 3)});
  const NearWallDrag fit = fit_near_wall_drag(speeds);
  EXPECT_NEAR(fit.exponent, 4.0 / 3, 1e-12);
  EXPECT_NEAR(fit.drag, 0.07, 1e-12);
  EXPECT_NEAR(fit.exponent_error, 0, 1e-12);
}

TEST(NearWallDrag, HasTheErrorsThatRepeatedTrialsScatterBy) {
  // 4000 trials of 12 distances with a scatter of 0.2 in log(v_g/(v_t - v_g)): squared errors are known to a
  // few percent.
  std::mt19937 engine(5);
  std::normal_distribution<double> noise(0, 0.2);
  double exponent_scatter = 0, exponent_estimate = 0, drag_scatter = 0, drag_estimate = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    std::vector<NearWallSpeed> speeds;
    for (int i = 0; i < 12; ++i) {
      const double d = 0.02 * std::pow(1.5, i);
      speeds.push_back({d, speed_at(d, 0.1 * std::exp(noise(engine)), 1.2)});
    }
    const NearWallDrag fit = fit_near_wall_drag(speeds);
    exponent_scatter += std::pow(fit.exponent - 1.2, 2);
    exponent_estimate += std::pow(fit.exponent_error, 2);
    drag_scatter += std::pow(std::log(fit.drag / 0.1), 2);
    drag_estimate += std::pow(fit.drag_error / fit.drag, 2);
  }
  EXPECT_NEAR(exponent_estimate / exponent_scatter, 1, 0.1);
  EXPECT_NEAR(drag_estimate / drag_scatter, 1, 0.1);
}

TEST(NearWallDrag, HasNoErrorFromTwoPoints) {
  const NearWallDrag fit = fit_near_wall_drag(std::vector<NearWallSpeed>{{0.1, 0.5}, {1, 0.9}});
  EXPECT_NEAR(fit.exponent, std::log10(9), 1e-12);
  EXPECT_TRUE(std::isnan(fit.exponent_error));
}

TEST(NearWallDrag, RefusesWhatHasNoLogarithm) {
  using Speeds = std::vector<NearWallSpeed>;
  EXPECT_THROW(fit_near_wall_drag(Speeds{{0.1, 0.5}}), std::invalid_argument);
  EXPECT_THROW(fit_near_wall_drag(Speeds{{0.1, 0.5}, {0.1, 0.6}}), std::invalid_argument);
  EXPECT_THROW(fit_near_wall_drag(Speeds{{0.1, 0.5}, {-1, 0.6}}), std::invalid_argument);
  EXPECT_THROW(fit_near_wall_drag(Speeds{{0.1, 0.5}, {1, 1}}), std::invalid_argument);
}

}  // namespace
}  // namespace clog::fit

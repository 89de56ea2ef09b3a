#include "clog/core/run/travel_speed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace clog {
namespace {

/// Values with mean zero and variance one (AR(1)). @param correlation  of neighbouring values
std::vector<double> correlated_noise(std::size_t size, double correlation, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values(size);
  double value = normal(engine);
  for (double& entry : values) {
    entry = value;
    value = correlation * value + std::sqrt(1 - correlation * correlation) * normal(engine);
  }
  return values;
}

/// The error of the mean of n = `size` values of correlated_noise(). The square of the error is
/// 1/n (1 + 2 sum_k (1 - k/n) c^k).
double exact_error(std::size_t size, double correlation) {
  const double n = static_cast<double>(size);
  double sum = 1;
  for (std::size_t k = 1; k < size; ++k)
    sum += 2 * (1 - static_cast<double>(k) / n) * std::pow(correlation, static_cast<double>(k));
  return std::sqrt(sum / n);
}

std::vector<TravelSample> integrated(const std::vector<double>& speeds, double interval) {
  std::vector<TravelSample> samples = {{0, 0}};
  for (const double speed : speeds)
    samples.push_back({samples.back().time + interval, samples.back().displacement + interval * speed});
  return samples;
}

TEST(TransientLength, IsZeroForSteadyMotion) {
  EXPECT_EQ(transient_length(std::vector<double>(100, 0.03)), 0u);
}

TEST(TransientLength, FindsWhereAStepEnds) {
  for (const std::size_t length : {20u, 95u, 200u}) {
    std::vector<double> speeds(500);
    for (std::size_t i = 0; i < speeds.size(); ++i)
      speeds[i] = (i % 2 == 0 ? 0.1 : -0.1) + (i < length ? 0 : 1);
    ASSERT_TRUE(transient_length(speeds).has_value());
    EXPECT_NEAR(static_cast<double>(*transient_length(speeds)), static_cast<double>(length), 5);
  }
}

/// The speeds have the mean 1 - exp(-t/tau) and the noise s. At the best cut t, the squared deviation
/// exp(-2 t/tau) of the mean is about equal to the variance s^2/5 of a batch's mean. So t is about
/// tau log(sqrt(5)/s). Chance shifts the cut by a few batches, usually to later times.
TEST(TransientLength, FindsWhereADecayDropsBelowTheNoise) {
  constexpr double tau = 40, noise = 0.05;
  const double expected = tau * std::log(std::sqrt(5.0) / noise);
  std::vector<double> cuts;
  for (unsigned seed = 1; seed <= 21; ++seed) {
    std::vector<double> speeds = correlated_noise(1000, 0, seed);
    for (std::size_t i = 0; i < speeds.size(); ++i)
      speeds[i] = 1 + noise * speeds[i] - std::exp(-static_cast<double>(i) / tau);
    ASSERT_TRUE(transient_length(speeds).has_value());
    cuts.push_back(static_cast<double>(*transient_length(speeds)));
  }
  std::sort(cuts.begin(), cuts.end());
  EXPECT_GT(cuts.front(), expected - tau);
  EXPECT_LT(cuts.back(), expected + 2 * tau);
  EXPECT_NEAR(cuts[10], expected, tau / 2);
}

TEST(TransientLength, DoesNotLookForStructureInRoundOff) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::vector<double> speeds = correlated_noise(500, 0.9, seed);
    for (double& speed : speeds) speed = 0.03 * (1 + 1e-15 * speed);
    EXPECT_EQ(transient_length(speeds), 0u);
  }
}

TEST(TransientLength, IsNotKnownWhileTheSpeedStillRises) {
  std::vector<double> speeds(300);
  for (int i = 0; i < 300; ++i) speeds[i] = 1 - std::exp(-i / 300.0);
  EXPECT_EQ(transient_length(speeds), std::nullopt);
  const TravelSpeed speed = travel_speed(integrated(speeds, 0.2));
  EXPECT_TRUE(std::isnan(speed.mean));
  EXPECT_TRUE(std::isnan(speed.error));
  EXPECT_TRUE(std::isnan(speed.transient));
}

TEST(TransientLength, IsNotKnownOfFewerThanFiftyValues) {
  EXPECT_EQ(transient_length(std::vector<double>(49, 1.0)), std::nullopt);
  EXPECT_EQ(transient_length(std::vector<double>(50, 1.0)), 0u);
  EXPECT_EQ(transient_length({}), std::nullopt);
}

TEST(BlockedError, OfWhiteNoiseIsTheErrorOfTheMean) {
  double sum = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) sum += blocked_error(correlated_noise(1000, 0, seed));
  EXPECT_NEAR(sum / 200 * std::sqrt(1000), 1, 0.02);
}

/// Compares the mean of many estimates with the true error. If the correlation were neglected, the estimates
/// would be 0.58 and 0.23 times the true error.
TEST(BlockedError, OfCorrelatedValuesCountsTheCorrelation) {
  for (const auto& [correlation, tolerance] : {std::pair{0.5, 0.05}, {0.9, 0.1}}) {
    double sum = 0;
    int known = 0;
    for (unsigned seed = 1; seed <= 400; ++seed) {
      const double error = blocked_error(correlated_noise(1000, correlation, seed));
      if (std::isnan(error)) continue;
      sum += error;
      ++known;
    }
    EXPECT_GT(known, 390);
    EXPECT_NEAR(sum / known / exact_error(1000, correlation), 1, tolerance) << correlation;
  }
}

/// The fraction of cases in which the true mean is within 1.96 errors.
double coverage(double correlation) {
  int covered = 0, known = 0;
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    const std::vector<double> values = correlated_noise(1000, correlation, seed);
    const double error = blocked_error(values);
    if (std::isnan(error)) continue;
    double mean = 0;
    for (const double value : values) mean += value / 1000;
    covered += std::abs(mean) < 1.96 * error;
    ++known;
  }
  return static_cast<double>(covered) / known;
}

TEST(BlockedError, CoversTheTruthNearlyAsOftenAsItSays) {
  EXPECT_NEAR(coverage(0), 0.95, 0.015);
  EXPECT_NEAR(coverage(0.5), 0.93, 0.02);
  EXPECT_NEAR(coverage(0.9), 0.89, 0.03);
}

TEST(BlockedError, IsNotKnownWhenTheCorrelationOutlastsTheValues) {
  EXPECT_TRUE(std::isnan(blocked_error(correlated_noise(200, 0.999, 1))));
  EXPECT_TRUE(std::isnan(blocked_error(std::vector<double>{1})));
  // There are too few values for an estimate.
  EXPECT_TRUE(std::isnan(blocked_error(std::vector<double>(199, 0.1))));
  EXPECT_EQ(blocked_error(std::vector<double>(200, 0.1)), 0);
}

TEST(TravelSpeed, IsTheMeanAfterTheTransient) {
  std::vector<double> speeds = correlated_noise(1000, 0.5, 3);
  for (std::size_t i = 0; i < speeds.size(); ++i) speeds[i] = (i < 100 ? 0.0 : 0.03) + 0.003 * speeds[i];
  const TravelSpeed speed = travel_speed(integrated(speeds, 0.2));
  EXPECT_NEAR(speed.transient, 20, 2.001);  // two batches of five intervals
  EXPECT_NEAR(speed.time, 200 - speed.transient, 1e-9);
  const auto rest = std::span(speeds).subspan(static_cast<std::size_t>(std::lround(speed.transient / 0.2)));
  EXPECT_NEAR(speed.error, blocked_error(rest), 1e-9 * speed.error);
  EXPECT_NEAR(speed.mean, 0.03, 3 * speed.error);
}

}  // namespace
}  // namespace clog

#include "clog/fit/mean_speed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace clog::fit {
namespace {

TEST(MeanSpeed, HasTheErrorOfTheMean) {
  const MeanSpeed fit = fit_mean_speed(std::vector<double>{1, 2, 3, 4});
  EXPECT_EQ(fit.num_runs, 4);
  EXPECT_DOUBLE_EQ(fit.mean, 2.5);
  EXPECT_DOUBLE_EQ(fit.standard_error, std::sqrt(5.0 / 3 / 4));
}

TEST(MeanSpeed, LeavesOutRunsWithoutASpeed) {
  const MeanSpeed fit = fit_mean_speed(std::vector<double>{1, NAN, 3});
  EXPECT_EQ(fit.num_runs, 2);
  EXPECT_DOUBLE_EQ(fit.mean, 2);
}

TEST(MeanSpeed, HasNoErrorForOneRunAndNoMeanForNone) {
  EXPECT_TRUE(std::isnan(fit_mean_speed(std::vector<double>{1}).standard_error));
  EXPECT_DOUBLE_EQ(fit_mean_speed(std::vector<double>{1}).mean, 1);
  EXPECT_TRUE(std::isnan(fit_mean_speed({}).mean));
}

TEST(SpeedRatio, WeighsRunsByTheirTime) {
  const MeanSpeed fit = fit_pooled_speed(std::vector<Travel>{{1, 1}, {9, 3}, {NAN, NAN}});
  EXPECT_EQ(fit.num_runs, 2);
  EXPECT_DOUBLE_EQ(fit.mean, 2.5);
  // The mean without the first run is 3, and without the second run it is 1.
  EXPECT_DOUBLE_EQ(fit.standard_error, 1);
}

TEST(SpeedRatio, OfEqualTimesIsTheMeanWithItsError) {
  const MeanSpeed ratio = fit_pooled_speed(std::vector<Travel>{{2, 2}, {4, 2}, {6, 2}, {8, 2}});
  const MeanSpeed mean = fit_mean_speed(std::vector<double>{1, 2, 3, 4});
  EXPECT_DOUBLE_EQ(ratio.mean, mean.mean);
  EXPECT_NEAR(ratio.standard_error, mean.standard_error, 1e-14);
}

TEST(SpeedRatio, HasNoErrorForOneRunAndNoMeanForNone) {
  EXPECT_TRUE(std::isnan(fit_pooled_speed(std::vector<Travel>{{1, 2}}).standard_error));
  EXPECT_DOUBLE_EQ(fit_pooled_speed(std::vector<Travel>{{1, 2}}).mean, 0.5);
  EXPECT_TRUE(std::isnan(fit_pooled_speed({}).mean));
}

/// Runs with times that differ by up to a factor of ten. The speed of a short run scatters more than that of
/// a long run.
std::vector<Travel> scattered_runs(int number, std::mt19937& engine) {
  std::uniform_real_distribution<double> log_time(0, std::log(10));
  std::normal_distribution<double> normal;
  std::vector<Travel> runs;
  for (int i = 0; i < number; ++i) {
    const double time = std::exp(log_time(engine));
    runs.push_back({time * (0.5 + 0.1 * normal(engine) / std::sqrt(time)), time});
  }
  return runs;
}

/// To first order in 1/n, the expected error is n/(n - 1) sum (d_i - R t_i)^2/(sum t)^2.
TEST(SpeedRatio, HasTheLinearisedErrorOfManyRuns) {
  std::mt19937 engine(1);
  const std::vector<Travel> runs = scattered_runs(1000, engine);
  const MeanSpeed fit = fit_pooled_speed(runs);
  double time = 0, squares = 0;
  for (const Travel& run : runs) {
    time += run.time;
    squares += std::pow(run.distance - fit.mean * run.time, 2);
  }
  EXPECT_NEAR(fit.standard_error / (std::sqrt(squares * 1000 / 999) / time), 1, 0.005);
}

TEST(SpeedRatio, ScattersAsItsErrorSays) {
  std::mt19937 engine(2);
  int covered = 0;
  double squares = 0, squared_errors = 0;
  constexpr int samples = 5000;
  for (int i = 0; i < samples; ++i) {
    const MeanSpeed fit = fit_pooled_speed(scattered_runs(20, engine));
    squares += std::pow(fit.mean - 0.5, 2);
    squared_errors += std::pow(fit.standard_error, 2);
    // Student's t with 19 degrees of freedom.
    covered += std::abs(fit.mean - 0.5) < 2.093 * fit.standard_error;
  }
  EXPECT_NEAR(squared_errors / squares, 1, 0.06);
  EXPECT_NEAR(static_cast<double>(covered) / samples, 0.95, 0.015);
}

TEST(SpeedRatio, OfSumsThatAreNotFiniteIsNotKnown) {
  const std::vector<Travel> long_ways{{1e308, 1}, {1e308, 1}}, long_times{{1, 1e308}, {1, 1e308}};
  EXPECT_TRUE(std::isnan(fit_pooled_speed(long_ways).mean));
  EXPECT_TRUE(std::isnan(fit_pooled_speed(long_times).mean));
}

}  // namespace
}  // namespace clog::fit

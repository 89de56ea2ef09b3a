#include "clog/fit/migration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace clog::fit {
namespace {

TEST(Migration, IsTheRatioOfTheSums) {
  // The slope is 6/12. The residuals are 1 - 2 = -1 and 5 - 4 = 1, so the error is sqrt(2 * 2/1)/12.
  const Migration fit = fit_migration(std::vector<Displacement>{{4, 1}, {8, 5}});
  EXPECT_DOUBLE_EQ(fit.slope, 0.5);
  EXPECT_DOUBLE_EQ(fit.standard_error, 2.0 / 12);
}

TEST(Migration, HasTheErrorThatEnsemblesScatterBy) {
  // There are 2000 ensembles of 20 runs. Distances are from 5 to 50, and the displacements scatter by 2 about
  // the slope -0.3. The mean squared error of the slope must be about equal to the mean of the squared
  // standard errors. The linear approximation has an error of 5 % for 20 runs, and the mean over 2000
  // ensembles has a standard error of 3 %.
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> distance(5, 50);
  std::normal_distribution<double> noise(0, 2);
  double squared_error = 0;
  double squared_estimate = 0;
  for (int ensemble = 0; ensemble < 2000; ++ensemble) {
    std::vector<Displacement> runs;
    for (int run = 0; run < 20; ++run) {
      const double along = distance(engine);
      runs.push_back({along, -0.3 * along + noise(engine)});
    }
    const Migration fit = fit_migration(runs);
    squared_error += std::pow(fit.slope + 0.3, 2);
    squared_estimate += std::pow(fit.standard_error, 2);
  }
  EXPECT_NEAR(squared_estimate / squared_error, 1, 0.12);
}

TEST(Migration, IsUndefinedWithoutDistance) {
  EXPECT_TRUE(std::isnan(fit_migration({}).slope));
  EXPECT_TRUE(std::isnan(fit_migration(std::vector<Displacement>{{0, 1}, {0, 2}}).slope));
  const Migration one = fit_migration(std::vector<Displacement>{{10, -2}});
  EXPECT_DOUBLE_EQ(one.slope, -0.2);
  EXPECT_TRUE(std::isnan(one.standard_error));
}

TEST(Migration, LeavesOutRunsThatWentTooShortAWay) {
  // The droplets with a distance of 0.04 did not leave their release void, so their lateral displacement
  // comes from this void alone.
  EXPECT_TRUE(std::isnan(fit_migration(std::vector<Displacement>{{0.04, -0.007}, {0.04, -0.007}}).slope));
  const Migration fit = fit_migration(std::vector<Displacement>{{4, 1}, {0.04, -0.4}, {8, 5}, {-0.1, 0.3}});
  EXPECT_DOUBLE_EQ(fit.slope, 0.5);
  EXPECT_DOUBLE_EQ(fit.standard_error, 2.0 / 12);
}

TEST(Migration, OfASumThatIsNotFiniteIsNotKnown) {
  const std::vector<Displacement> runs{{1e308, 1}, {1e308, 1}};
  EXPECT_TRUE(std::isnan(fit_migration(runs).slope));
}

}  // namespace
}  // namespace clog::fit

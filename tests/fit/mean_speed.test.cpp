#include "clog/fit/mean_speed.hpp"

#include <gtest/gtest.h>

#include <cmath>
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

}  // namespace
}  // namespace clog::fit

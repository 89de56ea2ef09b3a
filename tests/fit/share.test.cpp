#include "clog/fit/share.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace clog::fit {
namespace {

TEST(ShareInterval, IsThatOfBinomTest) {
  // From R: binom.test(8, 10).
  EXPECT_NEAR(share_interval(8, 10, 0.95).lower, 0.4439045, 1e-7);
  EXPECT_NEAR(share_interval(8, 10, 0.95).upper, 0.9747893, 1e-7);
}

TEST(ShareInterval, OfAllOrNoneFollowsFromOnePower) {
  const double each_side = 0.025;
  EXPECT_EQ(share_interval(0, 12, 0.95).lower, 0);
  EXPECT_NEAR(share_interval(0, 12, 0.95).upper, 1 - std::pow(each_side, 1.0 / 12), 1e-12);
  EXPECT_NEAR(share_interval(12, 12, 0.95).lower, std::pow(each_side, 1.0 / 12), 1e-12);
  EXPECT_EQ(share_interval(12, 12, 0.95).upper, 1);
}

TEST(ShareInterval, OfNothingSaysNothing) {
  EXPECT_EQ(share_interval(0, 0, 0.95).lower, 0);
  EXPECT_EQ(share_interval(0, 0, 0.95).upper, 1);
  EXPECT_THROW(share_interval(1, 2, 1), std::invalid_argument);
}

}  // namespace
}  // namespace clog::fit

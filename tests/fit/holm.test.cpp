#include "clog/fit/holm.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace clog::fit {
namespace {

TEST(Holm, IsThatOfPAdjustInR) {
  // From p.adjust(c(0.01, 0.04, 0.03, 0.005, 0.9), "holm") in R 4.2. An unknown p-value must not change the
  // others.
  const double unknown = std::nan("");
  const std::vector<double> adjusted = holm_adjusted(std::vector{0.01, 0.04, unknown, 0.03, 0.005, 0.9});
  const std::vector<double> expected = {0.04, 0.09, unknown, 0.09, 0.025, 0.9};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (std::isnan(expected[i])) {
      EXPECT_TRUE(std::isnan(adjusted[i]));
    } else {
      EXPECT_NEAR(adjusted[i], expected[i], 1e-15);
    }
  }
  EXPECT_EQ(holm_adjusted(std::vector{0.5, 0.6, 0.7}), (std::vector<double>{1, 1, 1}));
  EXPECT_TRUE(holm_adjusted({}).empty());
}

}  // namespace
}  // namespace clog::fit

#include "clog/fit/log_rank.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "absurd.hpp"
#include "leukaemia.hpp"

namespace clog::fit {
namespace {

TEST(LogRank, OfTheLeukaemiaTrialIsTheReferenceAnswer) {
  // From survdiff() in R's survival package 3.5-3.
  EXPECT_NEAR(log_rank_p_value(leukaemia_treated, leukaemia_placebo), 4.16880910933453e-05, 1e-15);
  EXPECT_NEAR(log_rank_p_value(leukaemia_placebo, leukaemia_treated), 4.16880910933453e-05, 1e-15);
}

TEST(LogRank, IsOneForEqualSidesAndNotKnownWithoutClogs) {
  EXPECT_NEAR(log_rank_p_value(leukaemia_treated, leukaemia_treated), 1, 1e-12);
  const std::vector<Observation> none = {{4, false}, {5, false}}, one = {{3, true}};
  EXPECT_TRUE(std::isnan(log_rank_p_value(none, none)));
  EXPECT_TRUE(std::isnan(log_rank_p_value({}, one)));
  // At the only clog one of three droplets clogs: (1/3)^2 expected is 1/3, the variance 2/9, chi-squared 2.
  EXPECT_NEAR(log_rank_p_value(one, none), std::erfc(1), 1e-12);
}

TEST(LogRank, OfAbsurdDistancesIsAProbabilityOrNotKnown) {
  for (const std::vector<Observation>& runs : absurd_runs()) {
    const double p = log_rank_p_value(runs, leukaemia_treated);
    EXPECT_TRUE(std::isnan(p) || (p >= 0 && p <= 1)) << runs.front().distance;
  }
}

TEST(Holm, IsThatOfPAdjustInR) {
  // From p.adjust(c(0.01, 0.04, 0.03, 0.005, 0.9), "holm") in R 4.2; values that are not known are no tests.
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

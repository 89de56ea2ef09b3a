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
  // At the only clog, three droplets are at risk, and one of them belongs to `one`. The expected number of
  // its clogs is 1/3, the variance is 2/9, and chi-squared is (2/3)^2/(2/9) = 2.
  EXPECT_NEAR(log_rank_p_value(one, none), std::erfc(1), 1e-12);
}

TEST(LogRank, OfAbsurdDistancesIsAProbabilityOrNotKnown) {
  for (const std::vector<Observation>& runs : absurd_runs()) {
    const double p = log_rank_p_value(runs, leukaemia_treated);
    EXPECT_TRUE(std::isnan(p) || (p >= 0 && p <= 1)) << runs.front().distance;
  }
}

}  // namespace
}  // namespace clog::fit

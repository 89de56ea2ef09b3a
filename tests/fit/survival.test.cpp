#include "clog/fit/survival.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "absurd.hpp"
#include "leukaemia.hpp"

namespace clog::fit {
namespace {

TEST(SurvivalCurve, OfTheLeukaemiaTrialIsTheReferenceAnswer) {
  // From survfit() in R's survival package.
  const std::vector<SurvivalStep> steps = survival_curve(leukaemia_treated);
  ASSERT_EQ(steps.size(), 7u);
  EXPECT_EQ(steps[0].distance, 6);
  EXPECT_EQ(steps[0].num_at_risk, 21);
  EXPECT_EQ(steps[0].num_clogs, 3);
  EXPECT_NEAR(steps[0].probability, 0.85714286, 1e-8);
  EXPECT_NEAR(steps[0].standard_error, 0.07636035, 1e-8);
  EXPECT_EQ(steps[2].distance, 10);
  EXPECT_EQ(steps[2].num_at_risk, 15);
  EXPECT_NEAR(steps[2].probability, 0.75294118, 1e-8);
  EXPECT_NEAR(steps[2].standard_error, 0.09634965, 1e-8);
  EXPECT_EQ(steps[6].distance, 23);
  EXPECT_NEAR(steps[6].probability, 0.44817927, 1e-8);  // by hand: 6/7 16/17 14/15 11/12 10/11 6/7 5/6
}

TEST(SurvivalCurve, HasTheReferenceAnswersLogLogInterval) {
  // From R's survfit(conf.type = "log-log"), which is also the default of SAS.
  const std::vector<SurvivalStep> steps = survival_curve(leukaemia_treated);
  EXPECT_NEAR(steps.front().interval.lower, 0.6197, 5e-5);
  EXPECT_NEAR(steps.front().interval.upper, 0.9516, 5e-5);
  EXPECT_NEAR(steps.back().interval.lower, 0.1881, 5e-5);
  EXPECT_NEAR(steps.back().interval.upper, 0.6801, 5e-5);
  EXPECT_THROW(survival_curve(leukaemia_treated, 1), std::invalid_argument);
}

TEST(SurvivalCurve, HasIntervalsWithinZeroAndOne) {
  for (const double confidence : {1e-20, 0.5, 0.95, 1 - 1e-15}) {
    for (const SurvivalStep& step : survival_curve(leukaemia_placebo, confidence)) {
      if (step.probability < 1e-12) continue;
      EXPECT_GE(step.interval.lower, 0);
      EXPECT_LE(step.interval.lower, step.probability);
      EXPECT_GE(step.interval.upper, step.probability);
      EXPECT_LE(step.interval.upper, 1);
    }
  }
  const SurvivalStep last = survival_curve(std::vector<Observation>{{1, true}}).front();
  EXPECT_TRUE(std::isnan(last.interval.lower) && std::isnan(last.interval.upper));
}

TEST(SurvivalCurve, OfUncensoredRunsIsTheirShare) {
  const std::vector<SurvivalStep> steps = survival_curve(leukaemia_placebo);
  EXPECT_EQ(steps.size(), 12u);
  for (const SurvivalStep& step : steps) {
    const double share = step.probability;
    EXPECT_NEAR(share * 21, std::round(share * 21), 1e-12);
    if (share > 1e-12) {
      EXPECT_NEAR(step.standard_error, std::sqrt(share * (1 - share) / 21), 1e-12);  // binomial
    }
  }
  EXPECT_NEAR(steps.back().probability, 0, 1e-15);
}

TEST(SurvivalCurve, HasNoStepsWithoutClogs) {
  EXPECT_TRUE(survival_curve(std::vector<Observation>{{5, false}}).empty());
  EXPECT_TRUE(survival_curve({}).empty());
}

TEST(Exponentiality, OfTheLeukaemiaTrialIsTheReferenceAnswer) {
  // From survreg() in R's survival package, with an exponential and a Weibull law.
  const WeibullTest treated = test_exponentiality(leukaemia_treated);
  EXPECT_NEAR(treated.exponential_likelihood, -42.1748803, 1e-7);
  EXPECT_NEAR(treated.shape, 1.3537345, 1e-7);
  EXPECT_NEAR(treated.likelihood_ratio, 1.032404, 1e-6);
  EXPECT_NEAR(treated.p_value, 0.309596, 1e-5);
  const WeibullTest placebo = test_exponentiality(leukaemia_placebo);
  EXPECT_NEAR(placebo.exponential_likelihood, -66.3491692, 1e-7);
  EXPECT_NEAR(placebo.shape, 1.3704999, 1e-7);
  EXPECT_NEAR(placebo.likelihood_ratio, 2.858123, 1e-6);
}

TEST(Exponentiality, IsRejectedAsOftenAsItClaimsAndWhereItFails) {
  std::mt19937_64 engine(3);
  const auto share_rejected = [&](double shape) {
    std::weibull_distribution<double> distance(shape, 5);
    int num_rejected = 0;
    constexpr int num_samples = 4000;
    for (int sample = 0; sample < num_samples; ++sample) {
      std::vector<Observation> runs;
      for (int i = 0; i < 50; ++i) {
        const double clog = distance(engine);
        runs.push_back({std::min(clog, 8.0), clog < 8});
      }
      num_rejected += test_exponentiality(runs).p_value < 0.05;
    }
    return static_cast<double>(num_rejected) / num_samples;
  };
  EXPECT_NEAR(share_rejected(1), 0.05, 0.012);  // the standard error is 0.0035
  EXPECT_GT(share_rejected(2), 0.9);
  EXPECT_GT(share_rejected(0.5), 0.9);
}

TEST(Exponentiality, SeesClogsAtRelease) {
  // Twelve of the thirty droplets do not move.
  std::mt19937_64 engine(7);
  std::exponential_distribution<double> distance(1);
  std::vector<Observation> runs(12, {-0.001, true});
  while (runs.size() < 30) runs.push_back({distance(engine), true});
  const WeibullTest test = test_exponentiality(runs);
  EXPECT_EQ(test.num_clogs, 30);
  EXPECT_LT(test.shape, 0.6);
  EXPECT_LT(test.p_value, 1e-4);
}

TEST(Exponentiality, OfAbsurdDistancesIsTestedOrNotKnown) {
  for (const std::vector<Observation>& runs : absurd_runs()) {
    const WeibullTest test = test_exponentiality(runs);
    EXPECT_TRUE(is_length_or_unknown(test.shape) || test.p_value == 0) << runs.front().distance;
    EXPECT_TRUE(std::isnan(test.p_value) || (test.p_value >= 0 && test.p_value <= 1));
  }
}

TEST(SurvivalCurve, OfAbsurdDistancesFallsFromOneToZero) {
  for (const std::vector<Observation>& runs : absurd_runs()) {
    double before = 1;
    for (const SurvivalStep& step : survival_curve(runs)) {
      EXPECT_GE(step.probability, 0);
      EXPECT_LT(step.probability, before);
      before = step.probability;
    }
  }
}

TEST(Exponentiality, OfClogsAtOneDistanceIsTested) {
  // From survreg() in R's survival package, with a Weibull and an exponential law.
  std::vector<Observation> runs(10, {5, true});
  runs.insert(runs.end(), 2, {8, false});
  const WeibullTest seen_beyond = test_exponentiality(runs);
  EXPECT_NEAR(seen_beyond.shape, 3.86072191591, 1e-7);
  EXPECT_NEAR(seen_beyond.scale, 6.15275738509, 1e-7);
  EXPECT_NEAR(seen_beyond.likelihood_ratio, 16.55062399204, 1e-7);
  // If no droplet travelled farther than the clogs, the likelihood grows without bound as Weibull's law
  // approaches a step.
  for (const double censored : {0.0, 3.0, 5.0}) {
    std::vector<Observation> step(10, {5, true});
    step.push_back({censored, false});
    const WeibullTest test = test_exponentiality(step);
    EXPECT_TRUE(std::isinf(test.shape));
    EXPECT_EQ(test.scale, 5);
    EXPECT_EQ(test.p_value, 0);
  }
}

TEST(EqualDistances, AreHalfOfTheDistancesOrMore) {
  EXPECT_FALSE(are_mostly_equal({}));
  EXPECT_FALSE(are_mostly_equal({1}));
  EXPECT_TRUE(are_mostly_equal({1, 1}));
  EXPECT_TRUE(are_mostly_equal({4, 1, 3, 1}));
  EXPECT_FALSE(are_mostly_equal({4, 1, 3, 1, 5}));
  EXPECT_TRUE(are_mostly_equal({2, 1, 2, 1, 5}));
  EXPECT_FALSE(are_mostly_equal({std::nan(""), std::nan("")}));
}

TEST(OnePlace, HoldsHalfOfTheDistancesOrMore) {
  // Five distances with a mean of 2: those at one place follow each other by 2/500 at most.
  EXPECT_TRUE(are_mostly_at_one_place({1.4966, 1.5, 1.5034, 2.5, 3}));
  EXPECT_FALSE(are_mostly_at_one_place({1.4966, 1.5, 1.505, 2.5, 2.9984}));
  // Two of three distances may be close by chance, and less than half of them are not most of them.
  EXPECT_FALSE(are_mostly_at_one_place({1, 1.0001, 3}));
  EXPECT_TRUE(are_mostly_at_one_place({1, 1.0001, 1.0002}));
  EXPECT_FALSE(are_mostly_at_one_place({1, 1.0001, 1.0002, 3, 4, 5, 6}));
  EXPECT_TRUE(are_mostly_at_one_place({1, 1.0001, 1.0002, 3, 4, 5}));
  EXPECT_TRUE(are_mostly_at_one_place({1, std::nan(""), 1.0001, 1.0002}));
  // Two places with less than half each, as the rows of a lattice have.
  EXPECT_FALSE(are_mostly_at_one_place({1, 1.0001, 1.0002, 2, 2.0001, 2.0002, 3}));
  EXPECT_FALSE(are_mostly_at_one_place({}));
  EXPECT_FALSE(are_mostly_at_one_place({std::nan(""), std::nan("")}));
  // 13 of 15 clogs of a device, within 2e-4 sigma.
  std::vector<double> device = {2.5, 9.1};
  for (int i = 0; i < 13; ++i) device.push_back(4.2 + 2e-4 * i / 12);
  EXPECT_TRUE(are_mostly_at_one_place(device));
}

TEST(OnePlace, IsNotFoundInRandomArrays) {
  std::mt19937 random(2027);
  std::exponential_distribution<double> distance(0.1);
  for (const std::size_t num_clogs : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 12u, 20u, 50u}) {
    int num_found = 0;
    constexpr int num_tables = 20000;
    for (int table = 0; table < num_tables; ++table) {
      std::vector<double> distances(num_clogs);
      for (double& one : distances) one = distance(random);
      num_found += are_mostly_at_one_place(std::move(distances)) ? 1 : 0;
    }
    // The chance is largest with 6 clogs: 40/600^2, from the spacings of the ordered distances.
    EXPECT_LE(num_found, 3e-4 * num_tables) << num_clogs;
  }
}

TEST(Exponentiality, SurvivesDegenerateData) {
  for (const std::vector<Observation>& runs : {std::vector<Observation>{},
                                               {{3, true}},
                                               {{0, true}, {0, true}},
                                               {{0, true}, {-1, true}},
                                               {{4, false}}}) {
    EXPECT_TRUE(std::isnan(test_exponentiality(runs).shape));
    EXPECT_TRUE(std::isnan(test_exponentiality(runs).p_value));
  }
  const std::vector<Observation> not_a_number{{std::nan(""), false}, {1, true}};
  EXPECT_EQ(survival_curve(not_a_number).size(), 1u);
  // The distances have very different magnitudes.
  const std::vector<Observation> tiny{{1e-9, true}, {3e-9, true}, {2e-9, false}},
      huge{{1e9, true}, {3e9, true}, {2e9, false}};
  EXPECT_NEAR(test_exponentiality(tiny).shape, test_exponentiality(huge).shape, 1e-9);
}

}  // namespace
}  // namespace clog::fit

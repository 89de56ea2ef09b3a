#include "clog/fit/incidence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "clog/fit/survival.hpp"

namespace clog::fit {
namespace {

CompetingEnd by(int cause, double distance) { return {distance, cause}; }
CompetingEnd going(double distance) { return {distance, std::nullopt}; }

/// Some runs end at equal distances: by the same cause, by different causes, or one by a cause while the
/// other is censored.
const std::vector<CompetingEnd> twenty_runs = {by(1, 1),  by(1, 2),  by(2, 2),  going(3),  by(1, 4),
                                               by(2, 4),  going(4),  by(2, 5),  by(1, 6),  by(1, 7),
                                               going(7),  by(2, 8),  by(1, 9),  by(2, 10), by(2, 10),
                                               going(11), by(1, 12), going(13), by(2, 14), by(1, 15)};

/// The expected values come from statsmodels 0.13.5, CumIncidenceRight(time, status). The errors from
/// statsmodels are NaN at the last distance, where all runs have ended.
TEST(CumulativeIncidence, IsTheReferenceAnswer) {
  struct Expected {
    double distance, probability, error;
  };
  const auto expect = [](int cause, const std::vector<Expected>& expected) {
    const std::vector<IncidenceStep> steps = cumulative_incidence(twenty_runs, cause);
    ASSERT_EQ(steps.size(), expected.size());
    for (std::size_t i = 0; i < steps.size(); ++i) {
      EXPECT_EQ(steps[i].distance, expected[i].distance);
      EXPECT_NEAR(steps[i].probability, expected[i].probability, 1e-8);
      if (!std::isnan(expected[i].error)) {
        EXPECT_NEAR(steps[i].standard_error, expected[i].error, 1e-8);
      }
    }
  };
  expect(1, {{1, 0.05, 0.04873397},
             {2, 0.1, 0.06708204},
             {4, 0.153125, 0.08148329},
             {6, 0.21033654, 0.09391811},
             {7, 0.26754808, 0.10302593},
             {9, 0.33111645, 0.11185826},
             {12, 0.41057692, 0.12260918},
             {15, 0.52976763, NAN}});
  expect(2, {{2, 0.05, 0.04873397},
             {4, 0.103125, 0.06913864},
             {5, 0.16033654, 0.08513104},
             {8, 0.22390491, 0.09946585},
             {10, 0.35104167, 0.11611091},
             {14, 0.47023237, 0.1354027}});
}

TEST(CumulativeIncidence, CountsRunsAtRiskAndEnds) {
  const std::vector<IncidenceStep> steps = cumulative_incidence(twenty_runs, 2);
  EXPECT_EQ(steps[1].num_at_risk, 16);
  EXPECT_EQ(steps[1].num_ends, 1);
  EXPECT_EQ(steps[4].num_at_risk, 7);
  EXPECT_EQ(steps[4].num_ends, 2);
  EXPECT_TRUE(cumulative_incidence(twenty_runs, 3).empty());
  EXPECT_THROW(cumulative_incidence(twenty_runs, 1, 0), std::invalid_argument);
}

TEST(CumulativeIncidence, OfUncensoredRunsIsTheirShareWithABinomialError) {
  std::vector<CompetingEnd> runs;
  runs.reserve(50);
  for (int i = 0; i < 50; ++i) runs.push_back(by(i % 3, 1 + 0.5 * (i - i % 2)));
  const auto all = static_cast<double>(runs.size());
  for (const int cause : {0, 1, 2})
    for (const IncidenceStep& step : cumulative_incidence(runs, cause)) {
      const double share =
          static_cast<double>(std::ranges::count_if(
              runs,
              [&](const CompetingEnd& run) { return run.cause == cause && run.distance <= step.distance; })) /
          all;
      EXPECT_NEAR(step.probability, share, 1e-12);
      EXPECT_NEAR(step.standard_error, std::sqrt(share * (1 - share) / all), 1e-12);
      EXPECT_LT(step.interval.lower, share);
      EXPECT_GT(step.interval.upper, share);
    }
}

/// For a single cause the incidence is one minus the survival curve, and its error is Greenwood's.
TEST(CumulativeIncidence, OfOneCauseIsOneMinusSurvival) {
  std::vector<CompetingEnd> runs = twenty_runs;
  std::vector<Observation> observations;
  for (CompetingEnd& run : runs) {
    if (run.cause) run.cause = 7;
    observations.push_back({run.distance, run.cause.has_value()});
  }
  const std::vector<IncidenceStep> steps = cumulative_incidence(runs, 7);
  const std::vector<SurvivalStep> survival = survival_curve(observations);
  ASSERT_EQ(steps.size(), survival.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_NEAR(steps[i].probability, 1 - survival[i].probability, 1e-12);
    EXPECT_NEAR(steps[i].standard_error, survival[i].standard_error, 1e-7);
  }
}

/// With constant rates 1/lambda_c the incidence is F_c(r) = (lambda/lambda_c) (1 - exp(-r/lambda)), where
/// 1/lambda is the sum of the rates. Runs are censored independently of the causes, as by max-time.
TEST(CumulativeIncidence, OfExponentialCausesIsTheirShareOfAllEnds) {
  const double lambda_1 = 10, lambda_2 = 30, lambda = 1 / (1 / lambda_1 + 1 / lambda_2);
  constexpr int num_samples = 400, num_runs = 100;
  std::mt19937 chance(5);
  const auto exponential = [&chance](double mean) {
    return -mean * std::log1p(-std::uniform_real_distribution<double>(0, 1)(chance));
  };
  const double place = 8, exact = lambda / lambda_2 * -std::expm1(-place / lambda);
  double sum = 0, squares = 0, covered = 0, variances = 0;
  for (int sample = 0; sample < num_samples; ++sample) {
    std::vector<CompetingEnd> runs;
    for (int i = 0; i < num_runs; ++i) {
      const double one = exponential(lambda_1), two = exponential(lambda_2), seen = 4 + exponential(20);
      const double end = std::min(one, two);
      runs.push_back(seen < end ? going(seen) : by(one < two ? 1 : 2, end));
    }
    const std::vector<IncidenceStep> steps = cumulative_incidence(runs, 2);
    const auto last = std::ranges::find_if(steps.rbegin(), steps.rend(),
                                           [&](const IncidenceStep& step) { return step.distance <= place; });
    ASSERT_NE(last, steps.rend());
    sum += last->probability;
    squares += last->probability * last->probability;
    variances += last->standard_error * last->standard_error;
    covered += last->interval.lower <= exact && exact <= last->interval.upper;
  }
  const double mean = sum / num_samples, scatter = squares / num_samples - mean * mean;
  EXPECT_NEAR(mean, exact, 4 * std::sqrt(scatter / num_samples));
  EXPECT_NEAR(variances / num_samples, scatter, 0.25 * scatter);
  EXPECT_NEAR(covered / num_samples, 0.95, 0.04);
}

}  // namespace
}  // namespace clog::fit

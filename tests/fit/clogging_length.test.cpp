#include "clog/fit/clogging_length.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "absurd.hpp"
#include "leukaemia.hpp"

namespace clog::fit {
namespace {

TEST(CloggingLength, OfTheLeukaemiaTrialIsTheReferenceAnswer) {
  // The length comes from the exponential fit of R's survival package. The intervals come from SciPy: one
  // from the quantiles of chi-squared with 19 degrees of freedom, the other from a root finder on the
  // likelihood.
  const CloggingLength fit = fit_clogging_length(leukaemia_treated);
  EXPECT_EQ(fit.num_runs, 21);
  EXPECT_EQ(fit.num_clogs, 9);
  EXPECT_EQ(fit.total_distance, 359);
  EXPECT_NEAR(fit.length, 39.8888889, 1e-7);
  EXPECT_NEAR(fit.interval.lower, 21.85537734, 1e-7);
  EXPECT_NEAR(fit.interval.upper, 80.61513179, 1e-7);
  EXPECT_NEAR(fit.profile.lower, 22.127305079, 1e-7);
  EXPECT_NEAR(fit.profile.upper, 83.013192793, 1e-7);
}

TEST(CloggingLength, OfRunsThatAllClogHasTheExactInterval) {
  const CloggingLength fit = fit_clogging_length(leukaemia_placebo);
  EXPECT_NEAR(fit.length, 8.6666667, 1e-7);
  EXPECT_NEAR(fit.interval.lower, 5.8921838, 1e-7);  // 42 degrees of freedom
  EXPECT_NEAR(fit.interval.upper, 14.00072052, 1e-7);
  EXPECT_NEAR(fit.profile.lower, 5.81371550991, 1e-7);
  EXPECT_NEAR(fit.profile.upper, 13.7353294255, 1e-7);
}

TEST(CloggingLength, OfOneClogByHand) {
  // The ends of the interval are 2 S/chi2. With 2 degrees of freedom, the quantiles of chi2 are -2 log(1 -
  // p).
  const std::vector<Observation> runs{{8, true}};
  const CloggingLength fit = fit_clogging_length(runs, 0.9);
  EXPECT_DOUBLE_EQ(fit.length, 8);
  EXPECT_NEAR(fit.interval.lower, 8 / -std::log(0.05), 1e-12);
  EXPECT_NEAR(fit.interval.upper, 8 / -std::log(0.95), 1e-12);
}

TEST(CloggingLength, HasAnIntervalForAnyConfidence) {
  // At a low confidence the interval is lambda exp(-+ z/sqrt(d)) with z = confidence sqrt(pi/2).
  for (const double confidence : {1e-300, 1e-20, 1e-8, 1e-3}) {
    const CloggingLength fit = fit_clogging_length(leukaemia_treated, confidence);
    const double width = confidence * std::sqrt(std::numbers::pi / 2 / fit.num_clogs);
    EXPECT_NEAR(std::log(fit.profile.lower / fit.length), -width, 1e-3 * width + 1e-15) << confidence;
    EXPECT_NEAR(std::log(fit.profile.upper / fit.length), width, 1e-3 * width + 1e-15) << confidence;
    EXPECT_LE(fit.interval.lower, fit.interval.upper);
  }
  const CloggingLength wide = fit_clogging_length(leukaemia_treated, 1 - 1e-15);
  EXPECT_LT(wide.profile.lower, wide.length / 4);
  EXPECT_GT(wide.profile.upper, wide.length * 4);
}

TEST(CloggingLength, WithoutClogsIsALowerBound) {
  const std::vector<Observation> runs{{100, false}, {50, false}};
  const CloggingLength fit = fit_clogging_length(runs, 0.95);
  EXPECT_TRUE(std::isnan(fit.length));
  EXPECT_NEAR(fit.interval.lower, 150 / std::log(20.0), 1e-12);  // exp(-150/lower) = 0.05
  EXPECT_TRUE(std::isinf(fit.interval.upper));
}

TEST(CloggingLength, SurvivesEmptyAndDegenerateData) {
  const CloggingLength nothing = fit_clogging_length({});
  EXPECT_EQ(nothing.num_runs, 0);
  EXPECT_EQ(nothing.interval.lower, 0);
  const std::vector<Observation> pushed_back{{-0.01, true}, {0.0, true}};
  EXPECT_EQ(fit_clogging_length(pushed_back).length, 0);
}

TEST(CloggingLength, OfAbsurdDistancesIsALengthOrNotKnown) {
  for (const std::vector<Observation>& runs : absurd_runs())
    EXPECT_TRUE(is_length_or_unknown(fit_clogging_length(runs).length)) << runs.front().distance;
}

TEST(CloggingLength, OfADistanceThatIsNotANumberIsNotKnown) {
  for (const double distance : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    const std::vector<Observation> runs{{3, true}, {distance, false}};
    const CloggingLength fit = fit_clogging_length(runs);
    EXPECT_EQ(fit.num_clogs, 1);
    for (const double number :
         {fit.length, fit.total_distance, fit.interval.lower, fit.interval.upper, fit.profile.lower})
      EXPECT_TRUE(std::isnan(number));
  }
}

TEST(CloggingLength, IntervalsCoverTheTruthAsOftenAsTheyClaim) {
  // The interval is exact if runs are censored after a given number of clogs. The coverage in 4000 samples
  // has a standard error of 0.0034.
  std::mt19937_64 engine(1);
  std::exponential_distribution<double> distance(1.0 / 7.0);
  int num_covered = 0;
  for (int sample = 0; sample < 4000; ++sample) {
    std::vector<double> distances(20);
    for (double& one : distances) one = distance(engine);
    std::sort(distances.begin(), distances.end());
    std::vector<Observation> runs;
    runs.reserve(distances.size());
    for (int i = 0; i < 20; ++i) runs.push_back({std::min(distances[i], distances[7]), i <= 7});
    const CloggingLength fit = fit_clogging_length(runs);
    num_covered += fit.interval.lower <= 7 && 7 <= fit.interval.upper;
  }
  EXPECT_NEAR(num_covered / 4000.0, 0.95, 0.014);
}

TEST(CloggingLength, IntervalsCoverTheTruthWhereRunsAreCensoredAfterSomeDistance) {
  // The fraction of runs that clog is between a quarter and nearly one. The coverage in 20000 samples has a
  // standard error of 0.0015. The true coverage differs from the nominal one because the number of clogs is a
  // whole number. The difference is largest if few clogs are expected (docs/explanation/statistics.md).
  std::mt19937_64 engine(2);
  std::exponential_distribution<double> distance(1);
  for (const double share : {0.25, 0.5, 0.75, 0.95}) {
    const double end = -std::log1p(-share);
    int num_covered = 0, num_covered_by_profile = 0;
    constexpr int num_samples = 20'000;
    for (int sample = 0; sample < num_samples; ++sample) {
      std::vector<Observation> runs;
      for (int i = 0; i < 20; ++i) {
        const double clog = distance(engine);
        runs.push_back({std::min(clog, end), clog < end});
      }
      const CloggingLength fit = fit_clogging_length(runs);
      num_covered += fit.interval.lower <= 1 && 1 <= fit.interval.upper;
      num_covered_by_profile += fit.profile.lower <= 1 && 1 <= fit.profile.upper;
    }
    EXPECT_NEAR(static_cast<double>(num_covered) / num_samples, 0.95, 0.01) << share;
    EXPECT_NEAR(static_cast<double>(num_covered_by_profile) / num_samples, 0.95, 0.015) << share;
  }
}

TEST(LeastSquaresLength, FindsTheLengthOfManyRuns) {
  std::vector<Observation> runs;
  constexpr int num_runs = 1000;
  runs.reserve(num_runs);
  for (int i = 0; i < num_runs; ++i) runs.push_back({-3 * std::log((i + 0.5) / num_runs), true});
  EXPECT_NEAR(least_squares_length(runs), 3, 0.01);
  for (Observation& run : runs)
    if (run.distance > 2) run = {2, false};
  EXPECT_NEAR(least_squares_length(runs), 3, 0.02);
}

TEST(LeastSquaresLength, MatchesAnotherOptimiser) {
  // From SciPy's curve_fit of exp(-r/lambda) to the same points.
  EXPECT_NEAR(least_squares_length(leukaemia_placebo), 9.2510204, 1e-4);
  EXPECT_NEAR(least_squares_length(leukaemia_treated), 42.134053, 1e-3);
  EXPECT_TRUE(std::isnan(least_squares_length(std::vector<Observation>{{3, true}, {5, false}})));
}

TEST(LeastSquaresLength, OfAbsurdDistancesIsALengthOrNotKnown) {
  // The search for the minimum would never end if the sum of squares were NaN.
  for (const std::vector<Observation>& runs : absurd_runs())
    EXPECT_TRUE(is_length_or_unknown(least_squares_length(runs))) << runs.front().distance;
}

TEST(LeastSquaresLength, HasNoUnit) {
  // Multiplication by powers of two does not round.
  std::vector<Observation> scaled(std::begin(leukaemia_treated), std::end(leukaemia_treated));
  for (Observation& run : scaled) run.distance *= 0x1p-900;
  EXPECT_EQ(least_squares_length(scaled), least_squares_length(leukaemia_treated) * 0x1p-900);
}

TEST(LeastSquaresLength, IsBiasedWhereTheFitIsNot) {
  // Runs of equal speed begin one after the other, and the sweep is observed while runs are in progress. Some
  // of the censored runs have covered little distance, but least squares treats them as runs that never clog.
  std::mt19937_64 engine(4);
  std::exponential_distribution<double> distance(1);
  double of_least_squares = 0, of_likelihood = 0;
  constexpr int num_samples = 500;
  for (int sample = 0; sample < num_samples; ++sample) {
    std::vector<Observation> runs;
    for (int i = 0; i < 40; ++i) {
      const double clog = distance(engine), seen = 3 * (i + 1) / 40.0;
      runs.push_back({std::min(clog, seen), clog < seen});
    }
    of_least_squares += least_squares_length(runs) / num_samples;
    of_likelihood += fit_clogging_length(runs).length / num_samples;
  }
  EXPECT_NEAR(of_likelihood, 1, 0.06);
  EXPECT_GT(of_least_squares, 1.2);
}

TEST(CloggingLength, RefusesAnImpossibleConfidence) {
  EXPECT_THROW(fit_clogging_length({}, 1.0), std::invalid_argument);
  EXPECT_THROW(fit_clogging_length({}, 0.0), std::invalid_argument);
}

/// The fits of a sweep that is observed when a given fraction of its runs is done. All droplets travel at the
/// same speed, and clog at exponentially distributed distances.
struct LiveSweep {
  double of_finished = 0;  ///< Clogging length from finished runs alone, divided by the true value.
  double of_all = 0;       ///< The same ratio from all runs; runs in progress are censored.
};
LiveSweep look_at(int num_workers, int num_runs, double share_done, std::mt19937& engine) {
  std::exponential_distribution<double> distance(1);
  std::multimap<double, double> running;  // the end of a run, and its beginning
  int num_begun = 0;
  for (; num_begun < num_workers; ++num_begun) running.emplace(distance(engine), 0);
  std::vector<Observation> finished;
  double now = 0;
  while (static_cast<double>(finished.size()) < share_done * num_runs) {
    const auto [end, begin] = *running.begin();
    running.erase(running.begin());
    now = end;
    finished.push_back({end - begin, true});
    if (num_begun++ < num_runs) running.emplace(now + distance(engine), now);
  }
  LiveSweep live;
  live.of_finished = fit_clogging_length(finished, 0.95).length;
  for (const auto& [end, begin] : running) finished.push_back({now - begin, false});
  live.of_all = fit_clogging_length(finished, 0.95).length;
  return live;
}

TEST(CloggingLength, IsNotTooShortWhileASweepRuns) {
  std::mt19937 engine(5);
  for (const auto& [num_workers, bias] : {std::pair{15, 0.5}, {63, 0.2}}) {
    // When 5 % of 300 runs are done, there are 15 finished runs.
    double of_finished = 0, of_all = 0;
    constexpr int num_sweeps = 2000;
    for (int i = 0; i < num_sweeps; ++i) {
      const LiveSweep live = look_at(num_workers, 300, 0.05, engine);
      of_finished += live.of_finished / num_sweeps;
      of_all += live.of_all / num_sweeps;
    }
    RecordProperty("finished_alone_" + std::to_string(num_workers), std::to_string(of_finished));
    EXPECT_LT(of_finished, bias) << num_workers;
    EXPECT_NEAR(of_all, 1, 0.02) << num_workers;
  }
}

}  // namespace
}  // namespace clog::fit

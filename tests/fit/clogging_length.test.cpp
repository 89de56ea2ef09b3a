#include "clog/fit/clogging_length.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace clog::fit {
namespace {

TEST(CloggingLength, OfTheLeukaemiaTrialIsTheReferenceAnswer) {
  // Remission times of the 6-MP arm, Freireich et al., Blood 21, 699 (1963); negative: censored.
  // Reference values: exponential fit of R's survival package, chi-squared interval with 2d degrees of
  // freedom.
  const double times[] = {6,   6,   6,   -6, 7,  -9,  10,  -10, -11, 13, 16,
                          -17, -19, -20, 22, 23, -25, -32, -32, -34, -35};
  std::vector<Observation> runs;
  for (const double time : times) runs.push_back({std::abs(time), time > 0});
  const CloggingLength fit = fit_clogging_length(runs);
  EXPECT_EQ(fit.num_runs, 21);
  EXPECT_EQ(fit.num_clogs, 9);
  EXPECT_EQ(fit.total_distance, 359);
  EXPECT_NEAR(fit.length, 39.8888889, 1e-7);
  EXPECT_NEAR(fit.lower, 22.7745791, 1e-7);
  EXPECT_NEAR(fit.upper, 87.2338890, 1e-7);
}

TEST(CloggingLength, OfOneClogByHand) {
  // 2 S/chi2 with 2 degrees of freedom, whose quantiles are -2 log(1 - p).
  const std::vector<Observation> runs{{3, true}, {5, false}};
  const CloggingLength fit = fit_clogging_length(runs, 0.9);
  EXPECT_DOUBLE_EQ(fit.length, 8);
  EXPECT_NEAR(fit.lower, 8 / -std::log(0.05), 1e-12);
  EXPECT_NEAR(fit.upper, 8 / -std::log(0.95), 1e-12);
}

TEST(CloggingLength, WithoutClogsIsALowerBound) {
  const std::vector<Observation> runs{{100, false}, {50, false}};
  const CloggingLength fit = fit_clogging_length(runs, 0.95);
  EXPECT_TRUE(std::isnan(fit.length));
  EXPECT_NEAR(fit.lower, 150 / std::log(20.0), 1e-12);  // exp(-150/lower) = 0.05
  EXPECT_TRUE(std::isinf(fit.upper));
}

TEST(CloggingLength, SurvivesEmptyAndDegenerateData) {
  const CloggingLength nothing = fit_clogging_length({});
  EXPECT_EQ(nothing.num_runs, 0);
  EXPECT_EQ(nothing.lower, 0);
  const std::vector<Observation> pushed_back{{-0.01, true}, {0.0, true}};
  EXPECT_EQ(fit_clogging_length(pushed_back).length, 0);
}

TEST(CloggingLength, IntervalsCoverTheTruthAsOftenAsTheyClaim) {
  // Censoring by the number of clogs: the interval is then exact. 4000 samples: standard error 0.0034.
  std::mt19937_64 engine(1);
  std::exponential_distribution<double> distance(1.0 / 7.0);
  int num_covered = 0;
  for (int sample = 0; sample < 4000; ++sample) {
    std::vector<double> distances;
    for (int i = 0; i < 20; ++i) distances.push_back(distance(engine));
    std::sort(distances.begin(), distances.end());
    std::vector<Observation> runs;
    for (int i = 0; i < 20; ++i) runs.push_back({std::min(distances[i], distances[7]), i <= 7});
    const CloggingLength fit = fit_clogging_length(runs);
    num_covered += fit.lower <= 7 && 7 <= fit.upper;
  }
  EXPECT_NEAR(num_covered / 4000.0, 0.95, 0.014);
}

TEST(CloggingLength, RefusesAnImpossibleConfidence) {
  EXPECT_THROW(fit_clogging_length({}, 1.0), std::invalid_argument);
  EXPECT_THROW(fit_clogging_length({}, 0.0), std::invalid_argument);
}

/// A sweep of equal droplets on some workers, looked at when a share of it is done: droplets clog at
/// exponentially distributed distances and travel at one speed.
struct LiveSweep {
  double of_finished = 0;  ///< lambda from finished runs alone, over the truth
  double of_all = 0;       ///< with the running ones as censored
};
LiveSweep look_at(int num_workers, int num_runs, double share_done, std::mt19937& engine) {
  std::exponential_distribution<double> distance(1);
  std::multimap<double, double> running;  // end of a run, its begin
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
    // 300 runs, 5 % done: 15 finished ones.
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

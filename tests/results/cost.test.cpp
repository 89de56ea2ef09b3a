#include "clog/results/cost.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace clog::results {
namespace {

constexpr double seconds_per_work = 1e-6;

RunCost finished(double seconds, double longest) {
  return {.seconds = seconds,
          .work = seconds / seconds_per_work,
          .longest_work = longest / seconds_per_work,
          .is_over = true};
}
RunCost unfinished(double seconds, double longest) {
  RunCost run = finished(seconds, longest);
  run.is_over = false;
  return run;
}
SweepCost cost(const std::vector<RunCost>& sample, std::int64_t num_runs) {
  const double longest = sample.front().longest_work;
  return sweep_cost(sample, longest * static_cast<double>(num_runs), num_runs);
}

TEST(SweepCost, OfASampleThatIsTheSweepIsKnown) {
  const SweepCost all = cost({finished(1, 100), finished(2, 100), finished(3, 100)}, 3);
  EXPECT_NEAR(all.seconds_per_work, seconds_per_work, 1e-15);
  EXPECT_NEAR(all.bound, 300, 1e-9);
  EXPECT_NEAR(all.expected, 6, 1e-9);
  EXPECT_NEAR(all.lower, 6, 1e-9);
  EXPECT_NEAR(all.upper, 6, 1e-9);
}

TEST(SweepCost, OfAKnownSweepIsTheSumThoughItsStepsDifferInCost) {
  std::vector<RunCost> sample = {finished(1, 2), finished(2, 2), finished(2, 2)};
  sample[1].work /= 3;
  EXPECT_NEAR(cost(sample, 3).expected, 5, 1e-9);
}

TEST(SweepCost, OfRunsThatAreOverIsTheirMeanTimesAll) {
  const SweepCost all = cost({finished(1, 100), finished(2, 100), finished(3, 100)}, 300);
  EXPECT_NEAR(all.expected, 600, 1e-9);
  EXPECT_LT(all.lower, 500);
  EXPECT_GT(all.upper, 700);
}

TEST(SweepCost, OfAParameterSetWithoutAnEndMayBeTheBound) {
  std::vector<RunCost> sample(24, finished(0.1, 300));
  for (std::size_t i = 0; i < sample.size(); i += 4) {
    sample[i] = unfinished(0.4, 300);
    sample[i].parameter_set = 1;
  }
  const SweepCost all = cost(sample, 2400);
  EXPECT_GT(all.upper, 0.25 * all.bound);
  EXPECT_GT(all.expected, 600 * 20.0);
  EXPECT_LT(all.expected, 600 * 100.0);
  EXPECT_LT(all.lower, 600 * 5.0);
}

TEST(SweepCost, OfRunsOfWhichNoneEndsIsAnythingUpToTheBound) {
  const SweepCost all = cost(std::vector<RunCost>(10, unfinished(1, 100)), 1000);
  EXPECT_NEAR(all.bound, 1e5, 1e-6);
  EXPECT_NEAR(all.upper, all.bound, 1e-6);
  EXPECT_GT(all.lower, 2000);  // the runs have computed for 10 s in total, and none of them has ended
  EXPECT_GT(all.expected, all.lower);
  EXPECT_LT(all.expected, all.bound);
}

TEST(SweepCost, IsTheBoundWhereEveryRunGoesToMaxTime) {
  const SweepCost all = cost({finished(10, 10), finished(10, 10)}, 100);
  EXPECT_NEAR(all.expected, all.bound, 1e-9);
  EXPECT_NEAR(all.upper, all.bound, 1e-9);
}

TEST(SweepCost, CountsWhatComesBeforeTheFirstStep) {
  std::vector<RunCost> sample(3, finished(1, 10));
  for (RunCost& run : sample) run.begin_seconds = 2;
  const SweepCost all = cost(sample, 100);
  EXPECT_NEAR(all.bound, 1200, 1e-9);
  EXPECT_NEAR(all.expected, 300, 1e-9);
}

TEST(SweepCost, WeighsRunsByWhatTheyMayCost) {
  // Half of the sweep's runs cost ten times as much as the others. The estimate weights the sampled runs by
  // their bounds, so it does not depend on how many runs of each kind were sampled.
  const std::vector<RunCost> sample = {finished(1, 10), finished(10, 100)};
  EXPECT_NEAR(sweep_cost(sample, 110 * 50 / seconds_per_work, 100).expected, 550, 1e-9);
}

RunCost of_set(std::int64_t set, RunCost run) {
  run.parameter_set = set;
  return run;
}
WaitingRuns waiting(std::int64_t set, std::int64_t number, double longest) {
  return {set, number, longest / seconds_per_work};
}

TEST(CostLeft, IsThatOfTheParameterSetsThatWait) {
  // All long runs have begun, but only a few of the short runs have.
  std::vector<RunCost> begun(20, of_set(0, finished(20, 100)));
  for (const double seconds : {0.5, 0.6, 0.7, 0.8}) begun.push_back(of_set(1, finished(seconds, 100)));
  const std::vector<WaitingRuns> waits = {waiting(0, 0, 100), waiting(1, 16, 100)};
  const SweepCost left = cost_left(begun, waits);
  EXPECT_NEAR(left.expected, 16 * 0.65, 1e-9);
  EXPECT_GT(left.lower, 16 * 0.4);
  EXPECT_LT(left.upper, 16 * 1.0);
  EXPECT_NEAR(left.bound, 16 * 100, 1e-6);
}

TEST(CostLeft, HasWhatUnfinishedRunsStillTake) {
  std::vector<RunCost> begun(10, of_set(0, finished(20, 100)));
  for (const double seconds : {0.5, 0.6, 0.7, 0.8}) begun.push_back(of_set(1, finished(seconds, 100)));
  begun.push_back(of_set(1, unfinished(0.4, 100)));
  const SweepCost left = cost_left(begun, {});
  // The only unfinished run belongs to the set with short runs, so its cost follows from the runs of this
  // set.
  EXPECT_GT(left.expected, 0.2);
  EXPECT_LT(left.expected, 2);
  EXPECT_GT(left.upper, left.expected);
  EXPECT_LT(left.lower, left.expected);
}

TEST(CostLeft, OfASetWithoutAnEndMayBeTheBound) {
  std::vector<RunCost> begun(10, of_set(0, finished(1, 100)));
  begun.push_back(of_set(1, unfinished(1, 100)));
  const std::vector<WaitingRuns> waits = {waiting(1, 9, 100)};
  EXPECT_GT(cost_left(begun, waits).upper, 0.9 * 999);
}

TEST(CostLeft, OfASetThatHasNotBegunIsTheMeanOfAll) {
  const std::vector<RunCost> begun = {of_set(0, finished(1, 100)), of_set(1, finished(3, 100))};
  const std::vector<WaitingRuns> waits = {waiting(2, 5, 100)};
  const SweepCost left = cost_left(begun, waits);
  EXPECT_NEAR(left.expected, 10, 1e-9);
  EXPECT_LT(left.lower, 2);
  EXPECT_GT(left.upper, 50);
}

TEST(CostLeft, IsNothingOnceAllIsOver) {
  const std::vector<RunCost> begun = {of_set(0, finished(1, 100)), of_set(1, finished(3, 100))};
  const SweepCost left = cost_left(begun, {});
  EXPECT_EQ(left.bound, 0);
  EXPECT_EQ(left.expected, 0);
  EXPECT_EQ(left.upper, 0);
}

TEST(CostLeft, CoversTheTruthWhereLongRunsBeginFirst) {
  std::mt19937 random(5);
  int num_covered = 0;
  constexpr int num_trials = 400;
  for (int trial = 0; trial < num_trials; ++trial) {
    const std::vector<double> means = {20, 0.9, 0.5};
    const std::vector<std::int64_t> num_begun = {24, 5, 5};
    std::vector<RunCost> begun;
    std::vector<WaitingRuns> waits;
    double truth = 0;
    for (std::size_t set = 0; set < means.size(); ++set) {
      std::exponential_distribution<> draw(1 / means[set]);
      for (std::int64_t i = 0; i < num_begun[set]; ++i)
        begun.push_back(of_set(static_cast<std::int64_t>(set), finished(draw(random), 1000)));
      waits.push_back(waiting(static_cast<std::int64_t>(set), 24 - num_begun[set], 1000));
      for (std::int64_t i = num_begun[set]; i < 24; ++i) truth += draw(random);
    }
    const SweepCost left = cost_left(begun, waits);
    num_covered += left.lower < truth && truth < left.upper;
  }
  EXPECT_GT(num_covered, 0.85 * num_trials);
}

/// The fraction of cases in which the interval contains the true cost. The sweep is a mixture of short and
/// long runs. @param num_sets  number of parameter sets to which the runs belong
double coverage(int num_sets) {
  // A third of the runs takes 0.1 s on average, another third 2 s, and the last third 40 s. Each of 24
  // sampled runs is followed for 0.4 s.
  std::mt19937 random(7);
  int num_covered = 0;
  constexpr int num_trials = 400;
  for (int trial = 0; trial < num_trials; ++trial) {
    std::vector<RunCost> sample;
    for (int i = 0; i < 24; ++i) {
      const double mean = i % 3 == 0 ? 0.1 : i % 3 == 1 ? 2 : 40;
      const double seconds = std::min(100.0, std::exponential_distribution<>(1 / mean)(random));
      sample.push_back(seconds < 0.4 ? finished(seconds, 100) : unfinished(0.4, 100));
      sample.back().parameter_set = i % num_sets;
    }
    const SweepCost all = cost(sample, 2400);
    const double truth = 800 * (0.1 + 2 + 40 * (1 - std::exp(-2.5)));
    num_covered += all.lower < truth && truth < all.upper;
  }
  return num_covered / static_cast<double>(num_trials);
}

TEST(SweepCost, CoversTheTruthWhereShortAndLongRunsMix) {
  EXPECT_GT(coverage(1), 0.8);   // There is one set, which contains all kinds of runs.
  EXPECT_GT(coverage(3), 0.9);   // There is one set for each kind of run.
  EXPECT_GT(coverage(24), 0.9);  // There are so many sets that only one run of each is known.
}

}  // namespace
}  // namespace clog::results

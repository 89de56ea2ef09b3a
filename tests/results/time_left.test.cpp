#include "clog/results/time_left.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace clog::results {
namespace {

SetTimes finished_set(std::int64_t number, double seconds) {
  return {.num_finished = number, .seconds = seconds * static_cast<double>(number)};
}

TEST(TimeLeft, IsNotKnownBeforeARunHasFinished) {
  const std::vector<SetTimes> sets = {{.num_running = 2, .num_waiting = 4, .seconds = 10}};
  EXPECT_FALSE(time_left(sets, 2).is_known);
}

TEST(TimeLeft, IsThatOfTheParameterSetsThatWait) {
  std::vector<SetTimes> sets = {finished_set(20, 1000), finished_set(25, 1)};
  sets[1].num_waiting = 40;
  const TimeLeft left = time_left(sets, 2);
  EXPECT_TRUE(left.is_known);
  // The ends of the 80 % interval differ from the mean by a factor of 1.292, because
  // log(1.292) = 1.2816/sqrt(25).
  EXPECT_NEAR(left.shortest, 20 / 1.292, 0.01);
  EXPECT_NEAR(left.longest, 20 * 1.292, 0.01);
}

TEST(TimeLeft, OfASetWithoutAnEndIsTheMeanOfAll) {
  std::vector<SetTimes> sets = {finished_set(20, 10), {}};
  sets[1].num_waiting = 4;
  const TimeLeft left = time_left(sets, 2);
  EXPECT_LT(left.shortest, 20);
  EXPECT_GT(left.longest, 20);
}

TEST(TimeLeft, HasATailOfRunsUnderWay) {
  std::vector<SetTimes> sets = {finished_set(100, 10), finished_set(100, 1000)};
  sets[0].num_running = 3;
  const double tail = 10 * (1 + 1. / 2 + 1. / 3);
  const TimeLeft left = time_left(sets, 3);
  EXPECT_LT(left.shortest, tail);
  EXPECT_GT(left.longest, tail);
  EXPECT_LT(left.longest, 1.2 * tail);
}

TEST(TimeLeft, CoversTheTruthWhereLongRunsBeginFirst) {
  std::mt19937 random(3);
  int num_covered = 0;
  constexpr int num_trials = 400;
  for (int trial = 0; trial < num_trials; ++trial) {
    const std::vector<double> means = {20, 0.9, 0.5};
    const std::vector<std::int64_t> num_begun = {24, 5, 5};
    std::vector<SetTimes> sets(means.size());
    double truth = 0;
    for (std::size_t i = 0; i < means.size(); ++i) {
      std::exponential_distribution<> draw(1 / means[i]);
      sets[i].num_finished = num_begun[i];
      sets[i].num_waiting = 24 - num_begun[i];
      for (std::int64_t run = 0; run < 24; ++run)
        (run < num_begun[i] ? sets[i].seconds : truth) += draw(random);
    }
    const TimeLeft left = time_left(sets, 1);
    num_covered += left.shortest < truth && truth < left.longest;
  }
  EXPECT_GT(num_covered, 0.7 * num_trials);  // the range is an interval of 80 %
}

}  // namespace
}  // namespace clog::results

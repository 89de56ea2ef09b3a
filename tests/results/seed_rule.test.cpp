#include "clog/results/seed_rule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <vector>

#include "clog/fit/clogging_length.hpp"

namespace clog::results {
namespace {

/// The ends of tasks: some tasks clog, and the others are censored.
auto statuses(const std::function<bool(std::int64_t task)>& has_clogged) {
  return [=](std::int64_t task) { return has_clogged(task) ? RunStatus::clogged : RunStatus::flowing; };
}

TEST(SeedRule, AsksForMoreOnlyWhereTheIntervalIsWide) {
  // In one of two parameter sets every droplet clogs, and in the other set every fourth droplet clogs. A
  // precision of 60 % requires 14 clogs.
  const auto has_clogged = [](std::int64_t task) { return task % 2 == 0 || task / 2 % 4 == 3; };
  SeedRule rule(0.6, 2, 16, 100);
  const std::vector<std::int64_t> next = rule.next_round(statuses(has_clogged));
  EXPECT_EQ(rule.num_reached(), 1);
  // With 4 clogs in 16 runs, 40 more runs are required. A round at most doubles the runs of a set, so the
  // first round adds 16.
  ASSERT_EQ(next.size(), 16u);
  for (std::size_t i = 0; i < next.size(); ++i) EXPECT_EQ(next[i], 2 * (16 + static_cast<int>(i)) + 1);
  EXPECT_EQ(rule.next_round(statuses(has_clogged)).size(),
            24u);  // With 8 clogs in 32 runs, 56 runs are required.
  EXPECT_TRUE(rule.next_round(statuses(has_clogged)).empty());
  EXPECT_EQ(rule.num_reached(), 2);
}

TEST(SeedRule, NamesWhatItDidNotReach) {
  sweep::Settings settings;
  settings.set("line-tension", "0.2,1");
  settings.set("seeds", "1..16");
  GrowingSweep sweep = growing_sweep(settings, 0.6, 20);
  const sweep::Plan plan(sweep.settings);
  const auto has_clogged = [](std::int64_t task) { return task % 2 == 1 || task == 0; };
  while (!sweep.rule.next_round(statuses(has_clogged)).empty()) {
  }
  EXPECT_EQ(
      outcome(sweep.rule, plan),
      "1 of 2 parameter sets reached --until-precision=60 %; not: line_tension=0.2 with 1 clog of 20 seeds "
      "(it takes 14 clogs); give more --most-seeds, or a longer max-time");
  const auto always = [](std::int64_t) { return true; };
  EXPECT_TRUE(sweep.rule.next_round(statuses(always)).empty());
  EXPECT_EQ(outcome(sweep.rule, plan), "2 of 2 parameter sets reached --until-precision");
}

TEST(SeedRule, AddsNoSeedsWhereAllRunsFail) {
  sweep::Settings settings;
  settings.set("line-tension", "0.2,1");
  settings.set("seeds", "1..16");
  GrowingSweep sweep = growing_sweep(settings, 0.6, 100'000);
  // In one set all runs fail. In the other set half of the runs fail, and this set reaches the precision.
  const auto status = [](std::int64_t task) {
    return task % 2 == 0 || task / 2 % 2 == 0 ? RunStatus::failed : RunStatus::clogged;
  };
  int num_rounds = 0;
  std::size_t num_added = 0;
  for (auto next = sweep.rule.next_round(status); !next.empty(); next = sweep.rule.next_round(status)) {
    ++num_rounds;
    num_added += next.size();
    for (const std::int64_t task : next) EXPECT_EQ(task % 2, 1);
  }
  EXPECT_EQ(num_rounds, 1);
  EXPECT_EQ(num_added, 12u);  // With 8 clogs in 16 runs, 28 runs are required.
  EXPECT_EQ(outcome(sweep.rule, sweep::Plan(sweep.settings)),
            "1 of 2 parameter sets reached --until-precision=60 %; not: line_tension=0.2 with 0 clogs of 16 "
            "seeds, 16 failed (it takes 14 clogs); give more --most-seeds, or a longer max-time");
}

TEST(SeedRule, SaysHowManyClogsAPrecisionTakes) {
  EXPECT_EQ(SeedRule(0.6, 2, 16, 100).clogs_needed(), 14);
  EXPECT_EQ(SeedRule(0.2, 1, 10, 50).clogs_needed(), 100) << "the budget does not matter";
}

TEST(SeedRule, StopsWhereTheIntervalIsNarrowEnough) {
  for (const int censored_of_three : {0, 1, 2})
    for (const double precision : {0.1, 0.3, 0.6}) {
      SeedRule rule(precision, 1, 10, 1'000'000);
      std::int64_t num_tasks = 10;
      const auto has_clogged = [=](std::int64_t task) { return task % 3 >= censored_of_three; };
      while (true) {
        const auto next = rule.next_round(statuses(has_clogged));
        if (next.empty()) break;
        num_tasks += static_cast<std::int64_t>(next.size());
      }
      EXPECT_EQ(rule.num_reached(), 1);
      std::vector<fit::Observation> runs;
      for (std::int64_t task = 0; task < num_tasks; ++task) runs.push_back({1, has_clogged(task)});
      const fit::CloggingLength fit = fit::fit_clogging_length(runs);
      const double reached = (fit.interval.upper - fit.interval.lower) / (2 * fit.length);
      EXPECT_LE(reached, precision) << censored_of_three;
      EXPECT_GT(reached, 0.75 * precision) << "it went on for too long";
    }
}

TEST(SeedRule, EndsAtTheBudgetWhereNothingClogs) {
  SeedRule rule(0.1, 3, 4, 25);
  std::set<std::int64_t> tasks;
  int num_rounds = 0;
  for (auto next = rule.next_round([](std::int64_t) { return RunStatus::flowing; }); !next.empty();
       next = rule.next_round([](std::int64_t) { return RunStatus::flowing; })) {
    EXPECT_TRUE(std::is_sorted(next.begin(), next.end()));
    for (const std::int64_t task : next) EXPECT_TRUE(tasks.insert(task).second) << "twice";
    ++num_rounds;
  }
  EXPECT_EQ(num_rounds, 3);  // the rounds have 8, 16 and 25 seeds
  EXPECT_EQ(tasks.size(), 3u * 21);
  EXPECT_EQ(*tasks.begin(), 12);
  EXPECT_EQ(*tasks.rbegin(), 74);
  EXPECT_EQ(rule.num_reached(), 0);
}

TEST(SeedRule, DoesNotBiasTheClogsThatItStopsAt) {
  // There are 400 sweeps of one parameter set. Distances are exponential, and censored at one clogging
  // length.
  std::mt19937 engine(11);
  std::exponential_distribution<double> distance(1);
  double mean = 0, covered = 0;
  constexpr int num_sweeps = 400;
  for (int sweep = 0; sweep < num_sweeps; ++sweep) {
    std::vector<fit::Observation> runs;
    const auto run_up_to = [&](std::int64_t task) {
      while (static_cast<std::int64_t>(runs.size()) <= task) {
        const double clog = distance(engine);
        runs.push_back({std::min(clog, 1.0), clog < 1});
      }
    };
    SeedRule rule(0.4, 1, 10, 1000);
    run_up_to(9);
    const auto has_clogged = [&](std::int64_t task) { return runs[static_cast<std::size_t>(task)].clogged; };
    for (auto next = rule.next_round(statuses(has_clogged)); !next.empty();
         next = rule.next_round(statuses(has_clogged)))
      run_up_to(next.back());
    const fit::CloggingLength fit = fit::fit_clogging_length(runs);
    mean += fit.length / num_sweeps;
    covered += (fit.interval.lower <= 1 && 1 <= fit.interval.upper) / static_cast<double>(num_sweeps);
  }
  EXPECT_NEAR(mean, 1, 0.04);  // the standard error is 0.009
  EXPECT_NEAR(covered, 0.95, 0.035);
}

}  // namespace
}  // namespace clog::results

#include "clog/results/families.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "clog/fit/survival.hpp"

namespace clog::results {
namespace {

Member member(const std::string& path, double diameter, double birth, double end, MemberEnd status) {
  return {.path = path,
          .diameter = diameter,
          .birth = {.distance = birth},
          .end = {.distance = end},
          .status = status};
}

/// A droplet that breaks at 15 into a half and two quarters. The half clogs at 40. One quarter is still
/// moving at 70, and the other is too small.
std::vector<Member> family() {
  const double half = std::sqrt(0.5), quarter = 0.5;
  return {member("", 1, 0, 15, MemberEnd::broken), member("0", half, 15, 40, MemberEnd::clogged),
          member("1", half, 15, 30, MemberEnd::broken), member("10", quarter, 30, 70, MemberEnd::flowing),
          member("11", quarter, 30, 30, MemberEnd::small)};
}

TEST(Families, CountEachPartOfTheAreaOnce) {
  const std::vector<ReleasedFamily> families = {{family()}};
  const Families found = families_of(families, 0.95);
  ASSERT_EQ(found.lines.size(), 3);  // at 10, 20 and 50
  EXPECT_EQ(found.num_daughters, 4);
  EXPECT_EQ(found.lines[0].passed.number, 1);
  EXPECT_EQ(found.lines[0].passed.mean, 1);
  EXPECT_EQ(found.lines[1].passed.number, 2);
  EXPECT_NEAR(found.lines[1].passed.mean, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(found.lines[2].passed.area, 0.25, 1e-15);
  EXPECT_NEAR(found.lines[2].clogged, 0.5, 1e-15);
  EXPECT_NEAR(found.lines[2].small, 0.25, 1e-15);
  for (const FamilyLine& line : found.lines)
    EXPECT_NEAR(line.passed.area + line.clogged + line.small + line.not_known, 1, 1e-14);
  EXPECT_NEAR(found.clogged.area, 0.5, 1e-15);
  EXPECT_EQ(found.clogged.numbers[14], 1);  // 0.707
}

/// If the run of a droplet failed, the rest of its path is unknown.
TEST(Families, CountTheAreaOfAFailedDaughterAsNotKnown) {
  std::vector<Member> members = family();
  members[1].status = MemberEnd::failed;  // the half that ends at 40
  const std::vector<ReleasedFamily> families = {{members}};
  const Families found = families_of(families, 0.95);
  const FamilyLine& line = found.lines[2];  // at 50
  EXPECT_EQ(line.clogged, 0);
  EXPECT_NEAR(line.not_known, 0.5, 1e-15);
  EXPECT_NEAR(line.passed.area + line.clogged + line.small + line.not_known, 1, 1e-15);
  EXPECT_EQ(found.clogged.number, 0);
  EXPECT_TRUE(std::isnan(line.passing)) << "the fate of the only family is not known";
}

TEST(Families, HaveNoLineBeyondTheFarthestDroplet) {
  const std::vector<ReleasedFamily> families = {{{member("", 1, 0, 9, MemberEnd::flowing)}}};
  EXPECT_TRUE(families_of(families, 0.95).lines.empty());
}

/// Without break-up, each family has one droplet, and the fraction of the area that passes a line equals the
/// estimate of Kaplan and Meier.
TEST(Families, ThatDoNotBreakUpGiveTheProductLimitEstimate) {
  std::vector<ReleasedFamily> families;
  std::vector<fit::Observation> runs;
  for (int i = 1; i <= 40; ++i) {
    const double distance = 3.7 * i;
    const bool clogs = i % 3 != 0;
    families.push_back({{member("", 1, 0, distance, clogs ? MemberEnd::clogged : MemberEnd::flowing)}});
    runs.push_back({distance, clogs});
  }
  const Families found = families_of(families, 0.95);
  const std::vector<fit::SurvivalStep> survival = fit::survival_curve(runs, 0.95);
  for (const FamilyLine& line : found.lines) {
    double expected = 1;
    for (const fit::SurvivalStep& step : survival)
      if (step.distance < line.distance) expected = step.probability;
    EXPECT_NEAR(line.passing, expected, 1e-12) << line.distance;
    EXPECT_LE(line.interval.lower, line.passing);
    EXPECT_GE(line.interval.upper, line.passing);
  }
}

/// The coordinates of a device begin elsewhere than the release.
TEST(Families, AreCountedAtMoreLinesAndFromTheRelease) {
  const double lines[] = {20, 17};
  const std::vector<ReleasedFamily> families = {{family()}}, released_at_4 = {{family(), 4}};
  const Families found = families_of(families, 0.95, lines),
                 in_device = families_of(released_at_4, 0.95, lines);
  ASSERT_EQ(found.lines.size(), 4);  // at 10, 17, 20 and 50
  EXPECT_EQ(found.lines[1].distance, 17);
  EXPECT_EQ(found.lines[1].passed.number, 2);
  EXPECT_EQ(in_device.lines[1].passed.number, 1) << "the ancestor broke up at 19";
}

/// A line counts only droplets that came from upstream.
TEST(Families, CountAtALineOnlyIfTheyWereReleasedBeforeIt) {
  const double lines[] = {4, 12};
  const std::vector<ReleasedFamily> families = {
      {{member("", 1, 0, 2, MemberEnd::clogged)}, 8},
      {{member("", 1, 0, 60, MemberEnd::flowing)}, 8},
      {{member("", 1, 0, 60, MemberEnd::flowing)}, 15},
  };
  const Families found = families_of(families, 0.95, lines);
  EXPECT_EQ(found.lines[0].distance, 10) << "a line at 4 is upstream of all releases";
  EXPECT_EQ(found.lines[1].distance, 12);
  EXPECT_EQ(found.lines[1].passed.number, 0.5) << "one of two";
  EXPECT_EQ(found.lines[1].passing, 0.5);
  EXPECT_NEAR(found.lines[2].passed.number, 2.0 / 3, 1e-15) << "at 20";
  for (const FamilyLine& line : found.lines)
    EXPECT_NEAR(line.passed.area + line.clogged + line.small + line.not_known, 1, 1e-14);
}

/// Which droplets are followed is the user's choice. If those that are not would pass like the others, the
/// share must not depend on this choice.
TEST(Families, GiveAShareThatDoesNotDependOnTheSmallestDaughter) {
  std::vector<ReleasedFamily> all(40), some(40);
  for (int i = 0; i < 40; ++i) {
    for (std::vector<ReleasedFamily>* families : {&all, &some}) {
      const bool is_small = families == &some && i % 2 == 0;
      const double half = std::sqrt(0.5);
      (*families)[i].members = {
          member("", 1, 0, 5, MemberEnd::broken),
          member("0", half, 5, i % 4 < 2 ? 8 : 20, i % 4 < 2 ? MemberEnd::clogged : MemberEnd::flowing),
          member("1", half, 5, is_small ? 5 : (i / 2 % 4 < 2 ? 8 : 20),
                 is_small        ? MemberEnd::small
                 : i / 2 % 4 < 2 ? MemberEnd::clogged
                                 : MemberEnd::flowing)};
    }
  }
  const FamilyLine of_all = families_of(all, 0.95).lines.front(),
                   of_some = families_of(some, 0.95).lines.front();
  EXPECT_NEAR(of_some.small, 0.25, 1e-12);
  EXPECT_NEAR(of_all.passing, of_some.passing, 0.01);
}

TEST(Families, AtALineBeyondAllDropletsAreUnknownUnlessAllEnded) {
  const std::vector<double> far = {1000};
  const std::vector<ReleasedFamily> moving = {{{member("", 1, 0, 30, MemberEnd::flowing)}},
                                              {{member("", 1, 0, 40, MemberEnd::flowing)}}};
  FamilyLine line = families_of(moving, 0.95, far).lines.back();
  EXPECT_EQ(line.not_known, 1);
  EXPECT_TRUE(std::isnan(line.passing) && std::isnan(line.interval.upper)) << line.passing;
  const std::vector<ReleasedFamily> clogged = {{{member("", 1, 0, 30, MemberEnd::clogged)}},
                                               {{member("", 1, 0, 40, MemberEnd::clogged)}}};
  line = families_of(clogged, 0.95, far).lines.back();
  EXPECT_EQ(line.passing, 0);
  EXPECT_NEAR(line.interval.upper, 1 - std::sqrt(0.025), 1e-12) << "none of two, by Clopper and Pearson";
}

TEST(Families, ThatAllPassHaveTheLowerBoundOfABinomialShare) {
  std::vector<ReleasedFamily> families(12, {{member("", 1, 0, 30, MemberEnd::flowing)}});
  const FamilyLine line = families_of(families, 0.95).lines.front();
  EXPECT_EQ(line.passing, 1);
  EXPECT_NEAR(line.interval.lower, 0.735, 5e-4) << "12 of 12 in tables of Clopper and Pearson";
  EXPECT_TRUE(std::isnan(line.passed.number_interval.lower)) << "all have one droplet";
}

/// Two families as if each passed whole or not at all: nothing narrower is known.
TEST(Families, ThatAreFewHaveTheIntervalOfABinomialShare) {
  std::vector<Member> members = family();
  members[3].end.distance = 45;
  members[3].status = members[4].status = MemberEnd::clogged;
  const std::vector<ReleasedFamily> families(2, {members});
  const FamilyLine line = families_of(families, 0.95).lines[1];
  EXPECT_EQ(line.distance, 20);
  const double places[] = {42};
  const FamilyLine at_42 = families_of(families, 0.95, places).lines.back();
  EXPECT_NEAR(at_42.passing, 0.25, 1e-15);
  EXPECT_LT(at_42.interval.lower, 0.01);
  EXPECT_GT(at_42.interval.upper, 0.8);
  EXPECT_TRUE(std::isnan(at_42.passed.number_interval.lower));
}

/// One family of twelve that loses a part does not make the share surer than twelve that lose none.
TEST(Families, OfWhichOneLosesAreaHaveNoNarrowerIntervalThanWithoutLoss) {
  std::vector<ReleasedFamily> families(12, {{member("", 1, 0, 30, MemberEnd::flowing)}});
  const double lower = families_of(families, 0.95).lines.front().interval.lower;
  families.back().members = {member("", 1, 0, 4, MemberEnd::broken),
                             member("0", std::sqrt(0.5), 4, 8, MemberEnd::clogged),
                             member("1", std::sqrt(0.5), 4, 30, MemberEnd::flowing)};
  const FamilyLine line = families_of(families, 0.95).lines.front();
  EXPECT_NEAR(line.passing, 23.0 / 24, 1e-12);
  EXPECT_LT(line.interval.lower, lower);
}

/// Halves that pass with a probability of 0.6, both or each by itself.
TEST(Families, HaveIntervalsThatContainTheTruthAboutAsOftenAsStated) {
  std::mt19937_64 engine(20261130);
  std::uniform_real_distribution<double> uniform;
  constexpr double share = 0.6;
  for (const int number : {3, 6, 12, 40}) {
    constexpr int num_trials = 200;
    int num_hits = 0;
    for (int trial = 0; trial < num_trials; ++trial) {
      std::vector<ReleasedFamily> families(number);
      for (ReleasedFamily& one : families) {
        one.members = {member("", 1, 0, 5, MemberEnd::broken)};
        for (const char* path : {"0", "1"}) {
          const bool passes = uniform(engine) < share;
          one.members.push_back(member(path, std::sqrt(0.5), 5, passes ? 20 : 8,
                                       passes ? MemberEnd::flowing : MemberEnd::clogged));
        }
      }
      const double places[] = {10};
      const fit::Interval found = families_of(families, 0.95, places).lines.front().interval;
      num_hits += found.lower <= share && share <= found.upper;
    }
    EXPECT_GE(num_hits, 0.9 * num_trials) << number << " families";
  }
}

}  // namespace
}  // namespace clog::results

#include "clog/sweep/plan.hpp"

#include <gtest/gtest.h>

#include <set>

#include "clog/core/tools/error.hpp"

namespace clog::sweep {
namespace {

Settings settings_of(std::initializer_list<std::pair<const char*, const char*>> texts) {
  Settings settings;
  for (const auto& [name, text] : texts) settings.set(name, text);
  return settings;
}

TEST(Plan, IsTheProductOfTheLists) {
  const Plan plan(settings_of({{"line-tension", "0.5,1,2"}, {"obstacle-gap", "0.2,0.3"}, {"seeds", "1..5"}}));
  EXPECT_EQ(plan.size(), 30);
  EXPECT_EQ(plan.num_groups(), 6);
  std::set<std::tuple<double, double, std::uint32_t>> seen;
  for (std::int64_t i = 0; i < plan.size(); ++i) {
    const RunParameters run = plan.task(i);
    seen.insert({run.dp.line_tension, run.obstacles.gap, run.seed});
  }
  EXPECT_EQ(seen.size(), 30u);
}

TEST(Plan, DoesEverySetOnceBeforeTheNextSeed) {
  const Plan plan(settings_of({{"line-tension", "0.5,1"}, {"seeds", "7..9"}}));
  for (std::int64_t i = 0; i < 6; ++i) EXPECT_EQ(plan.task(i).seed, 7 + i / 2);
}

TEST(Plan, RefusesListsThatLeadToTheSameRunTwice) {
  EXPECT_THROW(
      Plan(settings_of({{"obstacle-layout", "lattice"}, {"lattice-angle", "10,10.01"}, {"box", "20"}})),
      Error);
  EXPECT_THROW(Plan(settings_of({{"perimeter-stiffness", "auto,0.1"}})), Error);
  EXPECT_NO_THROW(Plan(settings_of({{"perimeter-stiffness", "auto,0.2"}})));
}

TEST(Plan, ChecksEverySetBeforeAnythingRuns) {
  EXPECT_THROW(Plan(settings_of({{"obstacle-gap", "0.2,0.001"}})), Error);
  EXPECT_THROW(Plan(settings_of({{"time-step", "1e-3,0.02"}})), Error);
}

TEST(Plan, RefusesKeysThatASoftDiskWouldIgnore) {
  try {
    const Plan plan(settings_of({{"model", "sp"}, {"wall-stiffness", "1"}, {"line-tension", "1,2"}}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("model=sp does not depend on it"), std::string::npos)
        << error.what();
  }
}

TEST(Plan, RefusesKeysThatAnotherLeavesWithoutEffect) {
  EXPECT_THROW(Plan(settings_of({{"perimeter-stiffness-ratio", "0.2"}})), Error);
  EXPECT_THROW(
      Plan(settings_of(
          {{"preset", "elastic"}, {"perimeter-stiffness-ratio", "0.2"}, {"perimeter-stiffness", "0.3"}})),
      Error);
  EXPECT_NO_THROW(Plan(settings_of({{"preset", "elastic"}, {"perimeter-stiffness-ratio", "0.2"}})));
  EXPECT_NO_THROW(Plan(settings_of({{"preset", "elastic"}, {"perimeter-stiffness", "0.3"}})));
}

}  // namespace
}  // namespace clog::sweep

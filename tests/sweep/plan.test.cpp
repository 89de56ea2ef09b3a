#include "clog/sweep/plan.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "clog/core/tools/error.hpp"
#include "support.hpp"

namespace clog::sweep {
namespace {

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

TEST(Plan, NamesAllAnglesThatFitNoBoxAtOnce) {
  const auto fault = [](const char* angles) -> std::string {
    try {
      const Plan plan(
          settings_of({{"obstacle-layout", "lattice"}, {"lattice-angle", angles}, {"box", "10"}}));
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  };
  const std::string all = fault("0,2,7,11.3");
  EXPECT_NE(all.find("invalid lattice-angle=2,7 (no lattice"), std::string::npos) << all;
  const std::string remedy = all.substr(all.find("use box=") + 8);
  const Settings wide = settings_of({{"obstacle-layout", "lattice"},
                                     {"lattice-angle", "0,2,7,11.3"},
                                     {"box", remedy.substr(0, remedy.find(' ')).c_str()}});
  EXPECT_NO_THROW(Plan{wide}) << "as the message says";
  EXPECT_NE(fault("0,7").find("invalid lattice-angle=7 (no lattice of spacing"), std::string::npos);
  EXPECT_NE(fault("80,81").find("45"), std::string::npos) << "is not looked for";
}

TEST(Plan, RefusesAPitchThatLeavesNoGapOrComesWithAnotherOne) {
  const auto lattice = [](const char* pitch, const char* gap) {
    return settings_of({{"obstacle-layout", "lattice"}, {"pitch", pitch}, {"obstacle-gap", gap}});
  };
  EXPECT_THROW(Plan(lattice("1e-9,0.2", "0.2")), Error);
  EXPECT_THROW(Plan(lattice("1.5", "0.3")), Error);
  EXPECT_EQ(Plan(lattice("1.5", "0.2")).task(0).obstacles.gap, 1.2);
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

TEST(Plan, HasOneSeedWhereNothingIsRandom) {
  for (const char* layout : {"channel", "wall"}) {
    Settings settings;
    settings.set("obstacle-layout", layout);
    EXPECT_EQ(Plan(settings).size(), 1) << layout;
    settings.set("seeds", "1..3");
    EXPECT_THROW(Plan{settings}, Error) << layout;
  }
}

TEST(Plan, TakesKeysOfAChannelForAChannel) {
  Settings settings;
  settings.set("orifice", "0.6,0.7");
  EXPECT_EQ(Plan(settings).size(), 2);
  EXPECT_EQ(Plan(settings).task(0).obstacles.layout, ObstacleLayout::channel);
  EXPECT_EQ(Plan(Settings::from_config(settings.to_config())).size(), 2);
  EXPECT_EQ(Plan(Settings::from_config(Settings().to_config())).task(0).obstacles.layout,
            ObstacleLayout::random)
      << "a config has every key";
}

Settings among_circles() {
  Settings settings;
  settings.set("box", "10");
  settings.set("seeds", "1");
  settings.set("obstacles", "one.csv");
  return settings;
}

TEST(Plan, NeedsTheCirclesThatItsSettingsName) {
  Settings settings = among_circles();
  EXPECT_EQ(settings.text("obstacle-layout"), "file");
  EXPECT_EQ(settings.missing_files(), std::vector<std::string>{"one.csv"});
  EXPECT_THROW(Plan{settings}, Error);
  settings.attach("one.csv", OwnCircles({{5, 5, 0.3}, {8, 5, 0.3}}));
  EXPECT_EQ(Plan(settings).task(0).obstacles.own->circles().size(), 2u);
  EXPECT_DOUBLE_EQ(Plan(settings).task(0).obstacles.gap, 2.4);
}

TEST(Plan, AsksHowWideAnArrayOfCirclesIs) {
  Settings settings;
  settings.attach("one.csv", OwnCircles({{5, 5, 0.3}, {8, 5, 0.3}}));
  settings.set("obstacles", "one.csv");
  try {
    const Plan plan(settings);
    FAIL() << "took a box of " << plan.task(0).obstacles.box;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("give box"), std::string::npos) << error.what();
  }
  settings.set("box", settings.text("box"));
  EXPECT_EQ(Plan(settings).size(), 1) << "even if it is the default's";
}

TEST(Plan, TravelsWithItsCircles) {
  Settings settings = among_circles();
  settings.attach("one.csv", OwnCircles({{1.0 / 3, 5, 0.1}, {8, 5, 0}}));
  const Settings again = Settings::from_packed(settings.packed());
  EXPECT_EQ(again.to_config(), settings.to_config());
  EXPECT_EQ(again.circle_files().at("one.csv").circles(), settings.circle_files().at("one.csv").circles());
  EXPECT_EQ(again.packed(), settings.packed());
}

TEST(Plan, RefusesWhatCirclesOfOnesOwnLeaveWithoutEffect) {
  const auto with = [](const char* key, const char* value) {
    Settings settings = among_circles();
    settings.attach("one.csv", OwnCircles({{5, 5, 0.3}}));
    settings.set(key, value);
    return settings;
  };
  for (const auto& [key, value] :
       {std::pair{"obstacle-gap", "0.3"}, std::pair{"obstacle-density", "0.3"},
        std::pair{"obstacle-diameter-spread", "0.1"}, std::pair{"lattice-angle", "10"},
        std::pair{"seeds", "1..3"}, std::pair{"obstacle-layout", "lattice"}})
    EXPECT_THROW(Plan{with(key, value)}, Error) << key;
  Settings anywhere = with("seeds", "1..3");
  anywhere.set("release", "anywhere");
  EXPECT_EQ(Plan(anywhere).size(), 3);
}

TEST(Plan, AsksAfterListsThatCouldBeDecimals) {
  const auto asked = [](const char* key, const char* text) {
    Settings settings;
    settings.set(key, text);
    return Plan(settings).possible_decimals();
  };
  EXPECT_EQ(asked("line-tension", "0,05"),
            std::vector<std::string>{"line-tension=0,05 is a list of 0 and 5; decimals have a point, 0.05"});
  for (const char* other : {"0", "0.05", "0,0.5", "0,1,2", "1,5", "0, 5"})
    EXPECT_TRUE(asked("line-tension", other).empty()) << other;
  EXPECT_TRUE(asked("seeds", "0,5").empty()) << "integers";
}

/// The line tension, gap, seed and preset of every task.
std::vector<std::tuple<double, double, std::uint32_t, std::string>> runs_of(const Plan& plan) {
  std::vector<std::tuple<double, double, std::uint32_t, std::string>> all;
  for (std::int64_t task = 0; task < plan.size(); ++task) {
    const RunParameters run = plan.task(task);
    all.emplace_back(run.dp.line_tension, run.obstacles.gap, run.seed, preset_name(run));
  }
  return all;
}

TEST(Plan, TakesListsOfWords) {
  const Plan plan(settings_of({{"preset", "robust,elastic"}, {"line-tension", "0.5,1"}, {"seeds", "1..2"}}));
  EXPECT_EQ(plan.num_groups(), 4);
  EXPECT_EQ(plan.size(), 8);
  EXPECT_EQ(preset_name(plan.task(0)), "robust");
  EXPECT_EQ(preset_name(plan.task(7)), "elastic");
  EXPECT_EQ(plan.task(7).dp.perimeter_spring, PerimeterSpring::rest);
}

TEST(Plan, HasTheProductOfTheOtherListsAtEachPoint) {
  Settings settings = settings_of({{"obstacle-gap", "0.2,0.3"}, {"seeds", "1..2"}});
  settings.set_points({{"line-tension", "preset"}, {{"0.5", "robust"}, {"2", "elastic"}, {"3", ""}}});
  const Plan plan(settings);
  EXPECT_EQ(plan.num_groups(), 6);
  EXPECT_TRUE(plan.has_equal_seeds());
  const auto runs = runs_of(plan);
  using Run = decltype(runs)::value_type;
  EXPECT_EQ(runs[0], Run(0.5, 0.2, 1, "robust"));
  EXPECT_EQ(runs[3], Run(2, 0.3, 1, "elastic"));
  EXPECT_EQ(runs[5], Run(3, 0.3, 1, "robust"));
  EXPECT_EQ(runs[6], Run(0.5, 0.2, 2, "robust"));
}

Settings points_with_seeds() {
  Settings settings;
  settings.set_points({{"line-tension", "seeds"}, {{"0.5", "1..3"}, {"2", "7"}, {"0.5", "10,11"}}});
  return settings;
}

TEST(Plan, JoinsThePointsThatDifferInTheirSeeds) {
  const Plan plan(points_with_seeds());
  EXPECT_EQ(plan.num_groups(), 2);
  EXPECT_EQ(plan.num_seeds(0), 5);
  EXPECT_EQ(plan.num_seeds(1), 1);
  std::vector<std::pair<double, std::uint32_t>> runs;
  for (std::int64_t task = 0; task < plan.size(); ++task)
    runs.emplace_back(plan.task(task).dp.line_tension, plan.task(task).seed);
  EXPECT_EQ(runs, (std::vector<std::pair<double, std::uint32_t>>{
                      {0.5, 1}, {2, 7}, {0.5, 2}, {0.5, 3}, {0.5, 10}, {0.5, 11}}));
}

TEST(Plan, FindsEveryTaskByItsGroupAndSeed) {
  const Plan plan(points_with_seeds());
  std::set<std::int64_t> tasks;
  for (std::int64_t group = 0; group < plan.num_groups(); ++group)
    for (std::int64_t place = 0; place < plan.num_seeds(group); ++place) {
      const std::int64_t task = plan.task_of(group, place);
      EXPECT_EQ(plan.group_of(task), group);
      tasks.insert(task);
    }
  EXPECT_EQ(std::ssize(tasks), plan.size());
}

TEST(Plan, IsTheSameAfterItsConfigWasReadBack) {
  Settings settings = settings_of({{"preset", "elastic,robust"}, {"box", "30"}});
  settings.set_points({{"line-tension", "seeds", "obstacles"}, {{"0.5", "1..3", ""}, {"2", "7,9", "none"}}});
  const Settings again = Settings::from_config(settings.to_config(Comments::help));
  EXPECT_EQ(again.to_config(), settings.to_config());
  EXPECT_EQ(runs_of(Plan(again)), runs_of(Plan(settings)));
  EXPECT_EQ(Settings::from_packed(settings.packed()).points().rows, settings.points().rows);
}

TEST(Plan, KeepsNamesOfFilesInPointsWhateverTheirBytes) {
  for (const char* name : {"a b.csv", "#x.csv", "*", "tab\there", "back\\slash"}) {
    Settings settings = settings_of({{"box", "10"}, {"seeds", "1"}});
    settings.set_points({{"obstacles"}, {{name}}});
    EXPECT_EQ(settings.missing_files(), std::vector<std::string>{name});
    EXPECT_EQ(Settings::from_config(settings.to_config()).points().rows, settings.points().rows) << name;
  }
}

TEST(Plan, IsTheUnionOfItsShards) {
  Settings settings =
      settings_of({{"line-tension", "0.5,1,2"}, {"obstacle-gap", "0.2,0.3"}, {"seeds", "1..7"}});
  const auto whole = runs_of(Plan(settings));
  std::multiset<decltype(whole)::value_type> joined;
  for (std::int64_t number = 1; number <= 4; ++number) {
    settings.set_shard({number, 4});
    const Plan part(Settings::from_config(settings.to_config()));
    const auto runs = runs_of(part);
    joined.insert(runs.begin(), runs.end());
    EXPECT_EQ(part.num_groups(), 6) << "every shard has seeds of each";
    EXPECT_NEAR(static_cast<double>(part.size()), static_cast<double>(whole.size()) / 4, 1.5);
  }
  EXPECT_EQ(joined, std::multiset<decltype(whole)::value_type>(whole.begin(), whole.end()));
}

TEST(Plan, NamesThePointThatCannotBe) {
  const auto message = [](const Points& points) -> std::string {
    try {
      Settings settings;
      settings.set_points(points);
      const Plan plan(settings);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message({{"line-tension"}, {{"1"}, {"-1"}}}).find("point 2: invalid line-tension=-1"),
            std::string::npos);
  EXPECT_NE(message({{"line-tension"}, {{"1"}, {"1.0"}}}).find("point 1 and point 2 mean the same"),
            std::string::npos);
  EXPECT_NE(message({{"line-tension", "line-tension"}, {{"1", "2"}}}).find("twice"), std::string::npos);
  EXPECT_NE(message({{"lime-tension"}, {{"1"}}}).find("did you mean line-tension"), std::string::npos);
  EXPECT_NE(message({{"line-tension"}, {{"1", "2"}}}).find("2 values for 1 key"), std::string::npos);
  EXPECT_NE(message({{"line-tension"}, {}}).find("no points"), std::string::npos);
  EXPECT_NE(
      message({{"line-tension"}, {{"1"}, {"x"}}, "p.csv"}).find("p.csv: point 2: invalid line-tension=x"),
      std::string::npos);
  EXPECT_NE(message({{"line-tension"}, {{"1"}, {"x"}}, "p.csv", {2, 4}}).find("p.csv line 4: invalid"),
            std::string::npos);
  for (const char* text : {"0/5", "6/5", "2", "a/b", "2/5/7", "-1/5"})
    EXPECT_THROW(Shard::from(text), Error) << text;
}

}  // namespace
}  // namespace clog::sweep

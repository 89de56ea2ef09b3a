/// For each parameter, checks that code which compares, groups, lists or shares runs distinguishes two values
/// of the parameter.

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <ostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "clog/core/parameters/schema.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/results/comparison.hpp"
#include "clog/results/groups.hpp"
#include "clog/results/preview.hpp"
#include "clog/results/usual_parameters.hpp"
#include "clog/sweep/obstacle_arrays.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/row_check.hpp"
#include "clog/sweep/run_row.hpp"
#include "clog/sweep/value_list.hpp"
#include "ended_row.hpp"

namespace clog::results {

/// Prints a parameter in the message of a failed test.
void PrintTo(const Parameter& parameter, std::ostream* out) { *out << parameter.key; }

namespace {

class EveryKey : public testing::TestWithParam<Parameter> {};

/// Settings to which the parameter applies.
sweep::Settings settings_for(const Parameter& parameter) {
  sweep::Settings settings;
  settings.set("seeds", "1");
  const std::string scope = parameter.scope->word;
  if (scope == "channel") {
    settings.set("obstacle-layout", "channel");
    return settings;
  }
  settings.set("box", "60");
  if (scope == "file") {
    settings.attach("one.csv", OwnCircles({{5, 5, 0.2}, {7, 5.5, 0.3}}));
    settings.attach("other.csv", OwnCircles({{5, 5, 0.2}, {7, 5.5, 0.4}}));
    settings.set("obstacles", "one.csv");
    if (std::string(parameter.key).starts_with("entrance")) settings.set("release", "entrance");
    return settings;
  }
  if (parameter.key != std::string("pitch")) settings.set("obstacle-gap", "0.6");
  if (scope == "lattice") settings.set("obstacle-layout", "lattice");
  const std::string key = parameter.key;
  if (key == "perimeter-stiffness-ratio" || key == "friction" || key == "yield-traction")
    settings.set("preset", "elastic");
  if (key == "film-friction") {
    settings.set("preset", "elastic");
    settings.set("friction", "0.1");
  }
  if (key == "break-up" || scope == "daughters") settings.set("break-up-neck", "0.05");
  if (scope == "daughters") settings.set("break-up", "daughters");
  if (key == "advancing-angle")
    settings.set("wall-tension", "0.5");  // Young's angle must be smaller than the largest possible angle
  if (parameter.key == std::string("gravity")) settings.set("preset", "heavy-interface");
  if (parameter.key == std::string("model")) settings.set("wall-stiffness", "1");
  return settings;
}

/// A value that differs from the one in the settings, as text for a config.
std::string other_value(const Parameter& parameter, const sweep::Settings& settings) {
  if (parameter.kind == ValueKind::file) return "other.csv";
  if (parameter.kind == ValueKind::text) return "angle = 20 deg; diameter = 1 mm";
  const ParameterValue value = parameter.get(sweep::Plan(settings).task(0));
  if (parameter.kind == ValueKind::word)
    return *std::ranges::find_if(parameter.words, [&](const std::string& word) {
      return word != "auto" && ParameterValue(word) != value;  // `auto` may mean the same value
    });
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer + 1);
  if (parameter.key == std::string("advancing-angle")) return "150";
  if (parameter.key == std::string("pitch")) return "0.8";
  if (parameter.key == std::string("exit")) return "40";  // downstream of the release at the centre
  if (parameter.key == std::string("length")) return "50";
  if (parameter.key == std::string("entrance-to")) return "10";
  if (parameter.unit == std::string("degrees")) return "10";  // a smaller change might not change the lattice
  if (const auto* number = std::get_if<double>(&value)) return shortest(*number == 0 ? 0.05 : 0.8 * *number);
  return "0.5";
}

/// The sweep over both values of a numeric parameter.
sweep::Plan plan_of_both(const Parameter& parameter) {
  sweep::Settings settings = settings_for(parameter);
  settings.set(parameter.key, settings.text(parameter.key) + "," + other_value(parameter, settings));
  return sweep::Plan(settings);
}

/// Two runs that differ in the parameter. The runs come from two sweeps, because a list of values cannot
/// contain words.
std::vector<RunParameters> both_runs(const Parameter& parameter) {
  sweep::Settings settings = settings_for(parameter);
  const RunParameters one = sweep::Plan(settings).task(0);
  settings.set(parameter.key, other_value(parameter, settings));
  return {one, sweep::Plan(settings).task(0)};
}

/// A sweep stores its settings in its file, and sends them to its ranks.
TEST_P(EveryKey, IsReadBackFromStoredSettings) {
  const Parameter& parameter = GetParam();
  sweep::Settings settings = settings_for(parameter);
  settings.set(parameter.key, other_value(parameter, settings));
  const sweep::Plan plan(settings), again(sweep::Settings::from_packed(settings.packed()));
  EXPECT_EQ(sweep::identity(sweep::describe(again.task(0))), sweep::identity(sweep::describe(plan.task(0))));
}

TEST_P(EveryKey, MakesTwoIdentities) {
  const auto runs = both_runs(GetParam());
  EXPECT_NE(sweep::identity(sweep::describe(runs[0])), sweep::identity(sweep::describe(runs[1])));
}

/// Lengths that differ by round-off are the same length.
TEST_P(EveryKey, IsComparedToTwelveDigitsIfItIsALength) {
  const Parameter& parameter = GetParam();
  if (parameter.unit != std::string("sigma")) return;
  const RunParameters run = sweep::Plan(settings_for(parameter)).task(0);
  const ParameterValue value = parameter.get(run);
  const auto* const length = std::get_if<double>(&value);
  if (!length || *length == 0) return;
  const auto identity_with = [&](double factor) {
    RunParameters other = run;
    parameter.set(other, *length * factor);
    return sweep::identity(sweep::describe(other));
  };
  EXPECT_EQ(identity_with(1 + 4e-16), identity_with(1));
  EXPECT_NE(identity_with(1 + 1e-9), identity_with(1));
}

TEST_P(EveryKey, MakesTwoGroups) {
  std::vector<sweep::RunRow> rows;
  for (const RunParameters& run : both_runs(GetParam())) rows.push_back(sweep::describe(run));
  EXPECT_EQ(group_runs(rows, 0.95).size(), GetParam().role == ParameterRole::ensemble ? 1u : 2u);
}

/// A sweep over four line tensions and two values of the parameter must have two curves. A comparison of the
/// two curves must name the parameter.
TEST_P(EveryKey, MakesTwoCurvesAndAComparisonIfItIsPhysics) {
  const Parameter& parameter = GetParam();
  if (parameter.role != ParameterRole::physics || parameter.key == std::string("line-tension")) return;
  std::vector<std::vector<sweep::RunRow>> sides;
  for (const RunParameters& run : both_runs(parameter)) {
    if (run.model != Model::dp || !has_clogging_length(sweep::describe(run))) return;
    auto& rows = sides.emplace_back();
    for (const double factor : {1.0, 1.1, 1.2, 1.3}) {
      RunParameters softer = run;
      softer.dp.line_tension = run.dp.line_tension * factor;
      sweep::RunRow row = sweep::describe(softer);
      row.task = 0;
      end_run(row, RunStatus::clogged, 5);
      rows.push_back(row);
    }
  }
  const auto column = std::ranges::find_if(group_columns(), [&](const sweep::Column* one) {
    return one->parameter && one->parameter->key == std::string(parameter.key);
  });
  if (column == group_columns().end()) return;  // the parameter's value is in another column
  EXPECT_NE(separating_value(**column, sides[0].front()), separating_value(**column, sides[1].front()));
  const Comparisons found =
      compare({{"one", sides[0], {"line_tension"}}, {"other", sides[1], {"line_tension"}}}, 0.95, {});
  EXPECT_NE(std::ranges::find(found.differing, (*column)->name), found.differing.end());
}

TEST_P(EveryKey, MakesTwoArraysIfItShapesThem) {
  const auto runs = both_runs(GetParam());
  EXPECT_EQ(sweep::array_key(runs[0]) != sweep::array_key(runs[1]), GetParam().shapes_array);
}

/// ObstacleArrays keeps the walls of the last run for the next run. The walls of a device with side walls
/// depend on the droplet's reach, because the reach limits where droplets may start. If the next run has
/// another droplet, it must get new walls.
TEST_P(EveryKey, LeavesTheNextRunOfADeviceItsOwnWalls) {
  sweep::Settings settings;
  settings.attach("one.csv", OwnCircles({{5, 5, 0.2}, {7, 5.5, 0.3}}));
  settings.attach("other.csv", OwnCircles({{5, 5, 0.2}, {7, 5.5, 0.4}}));
  for (const auto& [key, value] : {std::pair("obstacles", "one.csv"), std::pair("box", "60"),
                                   std::pair("side-walls", "on"), std::pair("release", "entrance")})
    settings.set(key, value);
  std::vector<RunParameters> runs;
  try {
    const std::string text = other_value(GetParam(), settings);
    for (const bool is_other : {false, true}) {
      if (is_other) settings.set(GetParam().key, text);
      runs.push_back(sweep::Plan(settings).task(0));
    }
  } catch (const Error&) {
    return;  // the key does not apply to a device
  }
  sweep::ObstacleArrays arrays;
  arrays.get(runs[0]);
  const auto walls = arrays.get(runs[1]);
  const ObstacleArray own = scene_of(runs[1]).walls(runs[1]);
  const auto place = [](const Obstacle& circle) { return std::array{circle.x, circle.y, circle.radius}; };
  EXPECT_TRUE(std::ranges::equal(walls->obstacles(), own.obstacles(), {}, place, place));
  const auto tip = [](const Wedge& wedge) { return std::array{wedge.tip[0], wedge.tip[1]}; };
  EXPECT_TRUE(std::ranges::equal(walls->wedges(), own.wedges(), {}, tip, tip));
}

TEST_P(EveryKey, MakesTwoLinesOfADryRun) {
  if (GetParam().kind == ValueKind::word) return;  // sweeps have no lists of words
  const sweep::Plan plan = plan_of_both(GetParam());
  testing::internal::CaptureStdout();
  print_tasks(plan, PreviewFormat::text);
  std::istringstream lines(testing::internal::GetCapturedStdout());
  std::string header, one, other;
  std::getline(lines, header);
  std::getline(lines, one);
  std::getline(lines, other);
  const auto without_number = [](const std::string& line) { return line.substr(line.find(' ')); };
  EXPECT_NE(without_number(one), without_number(other)) << header;
  EXPECT_GE(std::ranges::count(header, ' '), 2) << "the task's number, and what differs";
}

INSTANTIATE_TEST_SUITE_P(Schema, EveryKey,
                         testing::ValuesIn(parameter_schema().begin(), parameter_schema().end()),
                         [](const auto& one) {
                           std::string name = one.param.key;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace clog::results

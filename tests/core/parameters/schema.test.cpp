#include "clog/core/parameters/schema.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ostream>
#include <set>
#include <string>
#include <string_view>

#include "clog/core/tools/error.hpp"

namespace clog {

/// Prints a parameter in the message of a failed test.
void PrintTo(const Parameter& parameter, std::ostream* out) { *out << parameter.key; }

namespace {

class EveryParameter : public testing::TestWithParam<Parameter> {};

/// The parameters of a run to which this parameter applies.
RunParameters run_with(const Parameter& parameter) {
  RunParameters run;
  if (parameter.scope->word == std::string_view("daughters")) run.dp.break_up = BreakUp::daughters;
  for (const auto& [layout, word] : Words<ObstacleLayout>::all)
    if (!parameter.applies_to(run)) run.obstacles.layout = layout;
  return run;
}

std::string refusal(const RunParameters& run) {
  try {
    check_each(run);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST_P(EveryParameter, IsDescribed) {
  const Parameter& parameter = GetParam();
  EXPECT_GT(std::strlen(parameter.meaning), 10u);
  EXPECT_TRUE(parameter.applies_to(run_with(parameter)));
  if (parameter.kind == ValueKind::word) {
    EXPECT_GE(parameter.words.size(), 2u);
  } else if (parameter.kind == ValueKind::file || parameter.kind == ValueKind::text) {
    EXPECT_EQ(parameter.words, std::vector<std::string>{"none"});
  } else if (parameter.role != ParameterRole::ensemble) {
    EXPECT_GT(std::strlen(parameter.symbol), 0u);
    EXPECT_NE(text_of(parameter.range), "");
  }
}

TEST_P(EveryParameter, IsAllowedByDefault) { EXPECT_EQ(refusal(run_with(GetParam())), ""); }

TEST_P(EveryParameter, GivesBackWhatIsSet) {
  const Parameter& parameter = GetParam();
  RunParameters run = run_with(parameter);
  const ParameterValue value = parameter.get(run);
  ParameterValue other = value;
  if (auto* number = std::get_if<double>(&other)) *number += 0.25;
  if (auto* integer = std::get_if<std::int64_t>(&other)) *integer += 1;
  if (std::holds_alternative<std::monostate>(other) || parameter.kind == ValueKind::number_or_share)
    other = parameter.kind == ValueKind::integer ? ParameterValue(std::int64_t{20}) : ParameterValue(0.25);
  if (parameter.kind == ValueKind::file) other = OwnCircles({{1, 2, 3}}).check_sum();
  if (parameter.kind == ValueKind::text) other = LaboratoryText("angle = 1 deg").check_sum();
  if (parameter.kind == ValueKind::word)
    // The search begins with the last word. The first word of an automatic parameter is `auto`, which get()
    // never returns.
    other = *std::find_if(parameter.words.rbegin(), parameter.words.rend(),
                          [&](const auto& word) { return ParameterValue(word) != value; });
  ASSERT_NE(other, value);
  parameter.set(run, other);
  EXPECT_EQ(parameter.get(run), other);
  parameter.set(run, value);
  EXPECT_EQ(parameter.get(run), value);
}

TEST_P(EveryParameter, IsRefusedBeyondItsRange) {
  const Parameter& parameter = GetParam();
  if (parameter.kind == ValueKind::word || parameter.kind == ValueKind::file ||
      parameter.kind == ValueKind::text) {
    RunParameters run;
    EXPECT_THROW(parameter.set(run, "no such word"), Error);
    return;
  }
  const auto& [lower, upper] = parameter.range;
  for (const auto& [bound, outwards] : {std::pair(lower, -1.0), std::pair(upper, 1.0)}) {
    if (!bound) continue;
    RunParameters run = run_with(parameter);
    const double step = parameter.kind == ValueKind::integer ? 1 : 1e-9;
    const double beyond = bound->is_allowed
                              ? bound->value + outwards * step * std::max(1.0, std::abs(bound->value))
                              : bound->value;
    if (parameter.role == ParameterRole::ensemble) {
      EXPECT_THROW(parameter.set(run, static_cast<std::int64_t>(beyond)), Error) << "32 bits";
      continue;
    }
    if (parameter.kind == ValueKind::integer)
      parameter.set(run, static_cast<std::int64_t>(std::round(beyond)));
    else
      parameter.set(run, beyond);
    const std::string message = refusal(run);
    EXPECT_NE(message.find(std::string("invalid ") + parameter.key + "="), std::string::npos) << message;
    EXPECT_NE(message.find(bound->reason), std::string::npos) << message;
    EXPECT_GT(std::strlen(bound->remedy), 0u);
    EXPECT_TRUE(message.ends_with(bound->remedy)) << message;
  }
  if (parameter.kind != ValueKind::number) return;
  for (const double none : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    RunParameters run = run_with(parameter);
    parameter.set(run, none);
    EXPECT_NE(refusal(run), "") << none;
  }
}

TEST_P(EveryParameter, MayNotBeGivenWhereItMeansNothing) {
  const Parameter& parameter = GetParam();
  RunParameters run;
  run.model = Model::sp;
  if (parameter.applies_to(run)) return;
  if (parameter.kind == ValueKind::word)
    parameter.set(run, ParameterValue(parameter.words.back()) == parameter.get(run) ? parameter.words.front()
                                                                                    : parameter.words.back());
  else if (parameter.kind == ValueKind::file)
    parameter.set(run, OwnCircles({{1, 2, 3}}).check_sum());
  else if (parameter.kind == ValueKind::integer)
    parameter.set(run, std::int64_t{3});
  else
    parameter.set(run, 0.3);
  const std::string message = refusal(run);
  EXPECT_NE(message.find(parameter.key), std::string::npos) << message;
  EXPECT_TRUE(message.ends_with(parameter.scope->remedy)) << message;
}

INSTANTIATE_TEST_SUITE_P(Schema, EveryParameter,
                         testing::ValuesIn(parameter_schema().begin(), parameter_schema().end()),
                         [](const auto& one) {
                           std::string name = one.param.key;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST(Schema, HasEveryNameOnce) {
  std::set<std::string> keys, columns;
  for (const Parameter& parameter : parameter_schema()) {
    EXPECT_TRUE(keys.insert(parameter.key).second) << parameter.key;
    if (!parameter.has_own_column) continue;
    EXPECT_TRUE(columns.insert(parameter.column).second) << parameter.column;
  }
  EXPECT_LE(parameter_schema().size(), 64u) << "RunRow::unknown has a bit for each";
}

TEST(Schema, SaysARangeInWords) {
  EXPECT_EQ(text_of(parameter("vertices").range), "at least 16, at most 4096");
  EXPECT_EQ(text_of(parameter("terminal-speed").range), "above 0, at most 100");
  EXPECT_EQ(text_of(parameter("model").range), "");
}

}  // namespace
}  // namespace clog

#include "clog/sweep/row_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "clog/core/run/resolve.hpp"
#include "clog/sweep/columns.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/run_job.hpp"

namespace clog::sweep {
namespace {

using Keys = std::vector<std::pair<const char*, const char*>>;

Plan plan_of(const Keys& keys) {
  Settings settings;
  for (const auto& [name, text] : Keys{{"box", "20"}, {"obstacle-density", "saturated"}, {"seeds", "1"}})
    settings.set(name, text);
  for (const auto& [name, text] : keys) settings.set(name, text);
  if (settings.text("model") == "dp") settings.set("vertices", "64");
  return Plan(settings);
}

RunRow row_of(const Keys& keys) {
  const Plan plan = plan_of(keys);
  RunJob job(plan.task(0), 0);
  while (!job.advance()) continue;
  return job.row();
}

const std::vector<Keys> sweeps = {
    {{"max-time", "60"}, {"line-tension", "2"}},
    {{"max-time", "5"}, {"line-tension", "0.05"}},
    {{"max-time", "5"}, {"preset", "elastic"}},
    {{"max-time", "5"}, {"boxes", "3"}},
    {{"max-time", "5"}, {"preset", "heavy-interface"}},
    {{"max-time", "5"}, {"preset", "literal"}},
    {{"max-time", "5"}, {"line-tension", "0"}},
    {{"max-time", "5"}, {"near-wall-drag", "0.07"}, {"relative-drag", "0"}, {"wall-tension", "0.5"}},
    {{"max-time", "60"}, {"line-tension", "0.05"}, {"break-up-neck", "0.1"}, {"seeds", "3"}},
    {{"max-time", "60"}, {"line-tension", "2"}, {"clog-detection", "threshold"}, {"clog-energy", "1e-5"}},
    {{"max-time", "0.01"}, {"time-step", "3e-3"}},
    {{"max-time", "5"}, {"obstacle-density", "1.2"}, {"obstacle-diameter-spread", "0.3"}},
    {{"max-time", "5"}, {"obstacle-diameter-spread", "0.5"}},
    {{"max-time", "5"}, {"obstacle-layout", "lattice"}, {"box", "60"}, {"obstacle-gap", "1.2"}},
    {{"max-time", "200"}, {"model", "sp"}, {"wall-stiffness", "0.3"}},
    {{"max-time", "200"}, {"model", "sp"}, {"wall-stiffness", "100"}, {"terminal-speed", "100"}},
};

/// The row of a stiff polygon that has clogged. It has all results.
const RunRow& clogged() {
  static const RunRow row = row_of(sweeps.front());
  return row;
}

TEST(FaultOf, NoRowThatAJobGives) {
  for (const Keys& keys : sweeps) EXPECT_EQ(fault_of(row_of(keys)), "") << keys[1].first;
}

TEST(FaultOf, NoRunUnderWay) {
  const Plan plan = plan_of({{"max-time", "1e4"}, {"line-tension", "0.05"}});
  RunJob job(plan.task(0), 0);
  EXPECT_EQ(fault_of(job.row()), "");
  for (int i = 0; i < 5; ++i) {
    ASSERT_FALSE(job.advance());
    RunRow row = job.row();
    EXPECT_EQ(fault_of(row), "");
    row.status = RunStatus::running;
    EXPECT_EQ(fault_of(row), "");
  }
}

TEST(FaultOf, NoRunThatFailed) {
  RunRow row = clogged();
  row.status = RunStatus::failed;
  row.message = "diverged";
  row.distance = row.shape_parameter = std::nan("");
  row.failed_by = FailedBy::divergence;
  EXPECT_EQ(fault_of(row), "");
  row.sound_distance = 1e9;
  EXPECT_EQ(fault_of(row), "sound_distance=1e9 is not on the droplet's way");
  row.message = "";
  EXPECT_EQ(fault_of(row), "failed without a reason");
}

/// Rows in files of earlier versions have only some of the columns.
TEST(FaultOf, NoColumnThatAnOlderVersionDidNotHave) {
  RunRow row = clogged();
  for (const char* name :
       {"near_wall_cutoff", "contact_range",   "self_contact_range", "mean_speed_error",  "transient",
        "travel_time",      "mechanism",       "wrapped_support",    "num_wrapped",       "num_gaps",
        "num_arcs",         "clogged_by",      "stability",          "mesh_hold",         "failed_by",
        "sound_distance",   "friction_use",    "healed_crossings",   "dwells_known_from", "last_dwell_at",
        "last_dwell_from",  "steady_distance", "steady_time"})
    column(name).set_unknown(row);
  EXPECT_EQ(fault_of(row), "near_wall_cutoff is not known") << "this version has it";
  row.model_version = model_version - 1;
  EXPECT_EQ(fault_of(row), "");
}

/// The final row of a short run with the given layout.
RunRow row_in(ObstacleLayout layout) {
  RunParameters run;
  run.dp.vertices = 64;
  run.max_time = 1;
  run.obstacles.layout = layout;
  if (layout == ObstacleLayout::file) {
    run.obstacles.own = OwnCircles({{5, 5, 0.2}, {7, 5.5, 0.3}});
    run.obstacles.box = 10;
  }
  RunJob job(resolve(run), 0);
  while (!job.advance()) continue;
  return job.row();
}

/// The row of a run to which the column applies.
const RunRow& row_with(const Column& column) {
  static const RunRow rows[] = {clogged(), row_in(ObstacleLayout::channel), row_in(ObstacleLayout::wall),
                                row_in(ObstacleLayout::file)};
  const auto* row = std::ranges::find_if(rows, [&](const RunRow& one) {
    const Value value = column.get(one);
    return value != Value() && value != Value("none");
  });
  return row == std::end(rows) ? rows[0] : *row;
}

TEST(FaultOf, NamesPlacesOfReleaseThatVersion10GotWrong) {
  RunRow row = row_in(ObstacleLayout::wall);
  row.parameters.obstacles.layout = ObstacleLayout::file;
  row.parameters.obstacles.box = 5;
  row.sag.centre = row.sag.top = RunRow::not_known;
  row.release[1] = 4;
  const auto fault_at = [&](std::int64_t model, double x) {
    row.model_version = model;
    row.release[0] = x;
    return fault_of(row);
  };
  // The values of x are from a sweep by version 1.0, with the circle 2.5,2.5,2, box=5 and release=anywhere.
  for (const double x : {10.005285169751458, 9.5099, -2.6}) {
    EXPECT_NE(
        fault_at(11, x).find("is a period away from where the droplet started, an error of clogsweep 1.0"),
        std::string::npos);
    EXPECT_NE(fault_at(12, x).find("is not in the array"), std::string::npos);
  }
  for (const double x : {5.0563, -0.027}) {
    EXPECT_EQ(fault_at(11, x), "") << "across the border, which 1.0 allows";
    EXPECT_NE(fault_at(12, x).find("is not in the array"), std::string::npos);
  }
  EXPECT_EQ(fault_at(12, 4.99), "");
}

TEST(FaultOf, NoRunInAnyScene) {
  for (const ObstacleLayout layout : {ObstacleLayout::channel, ObstacleLayout::wall, ObstacleLayout::file})
    EXPECT_EQ(fault_of(row_in(layout)), "") << name(layout);
}

TEST(FaultOf, NamesWhatBelongsToAnotherScene) {
  RunRow row = clogged();
  row.sag.centre = 0.1;
  EXPECT_EQ(fault_of(row), "sag=0.1, but there is no wall");
  row = row_in(ObstacleLayout::channel);
  EXPECT_GE(row.passage.largest_shape_parameter.value, 1);
  row.passage.largest_shape_parameter.value = 0.5;
  EXPECT_EQ(fault_of(row), "largest_shape_parameter=0.5 is that of no droplet");
  row = row_in(ObstacleLayout::channel);
  row.parameters.channel.orifice = 1e-3;
  EXPECT_NE(fault_of(row).find("invalid orifice=0.001"), std::string::npos);
}

/// Writes a value into a column of a row. @return the fault of the changed row
template <class T>
std::string fault_with(const Column& column, T value) {
  const RunRow& row = row_with(column);
  std::vector<std::byte> bytes(packed_size());
  pack(row, bytes);
  std::size_t place = 0;
  for (const Column& other : columns()) {
    if (other.name == column.name) break;
    place += other.size;
  }
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(place), column.size, std::byte{0});
  if constexpr (std::is_same_v<T, std::string>)
    std::memcpy(&bytes[place], value.data(), value.size());
  else
    std::memcpy(&bytes[place], &value, sizeof value);
  const UnpackedRow unpacked = unpack(bytes);
  return unpacked.fault.empty() ? fault_of(unpacked.row) : unpacked.fault;
}

TEST(Unpack, NamesEveryWordThatIsUnknown) {
  int num_tried = 0;
  for (const Column& column : columns()) {
    if (column.kind != ValueKind::word || column.role == ColumnRole::circumstance) continue;
    if (column.name == "preset") continue;  // another version may have other presets
    const char* what = column.name == "obstacles" ? "is no checksum of circles"
                       : column.name == "laboratory"
                           ? "is no description of a laboratory; give a file by --lab"
                           : "is unknown";
    EXPECT_EQ(fault_with<std::string>(column, "wrapqed"), column.name + "='wrapqed' " + what);
    ++num_tried;
  }
  EXPECT_EQ(num_tried, 18);
}

TEST(Unpack, KeepsWhatIsUnknown) {
  RunRow row = clogged();
  EXPECT_EQ(row.clogged_by, FoundBy::certified);
  const RunRow known = row;
  const char* const names[] = {"clogged_by", "mechanism", "contacts",      "num_wrapped",
                               "num_gaps",   "num_arcs",  "contact_range", "wrapped_support"};
  for (const char* name : names) column(name).set_unknown(row);
  std::vector<std::byte> bytes(packed_size());
  pack(row, bytes);
  const UnpackedRow again = unpack(bytes);
  EXPECT_EQ(again.fault, "");
  for (const char* name : names) {
    EXPECT_NE(column(name).get(known), Value()) << name;
    EXPECT_EQ(column(name).get(again.row), Value()) << name;
  }
}

TEST(Unpack, SeparatesNotCloggedFromUnknown) {
  RunRow row = clogged();
  row.clogged_by = FoundBy::not_clogged;
  EXPECT_EQ(column("clogged_by").get(row), Value("none"));
  EXPECT_EQ(fault_of(row), "clogged, but clogged_by='none'");
  row.clogged_by.reset();
  EXPECT_EQ(fault_of(row), "");
}

TEST(FaultOf, StabilityThatDoesNotFitTheClog) {
  RunRow row = clogged();
  for (const Stability no_clog : {Stability::none, Stability::unstable}) {
    row.stability = no_clog;
    EXPECT_EQ(fault_of(row), "stability='" + std::string(name(no_clog)) + "', but status='clogged'");
  }
  row.stability = Stability::unknown;
  EXPECT_EQ(fault_of(row), "certified, but stability='unknown'");
  row.clogged_by = FoundBy::threshold;
  row.kinetic_energy_ratio = 0.1 * row.parameters.clog_energy;
  EXPECT_EQ(fault_of(row), "");
  row.stability.reset();
  EXPECT_EQ(fault_of(row), "");
}

TEST(FaultOf, NamesEveryNumberThatIsNone) {
  std::set<std::string> may_be_unknown = {"mean_speed",
                                          "mean_speed_error",
                                          "transient",
                                          "travel_time",
                                          "steady_distance",
                                          "steady_time",
                                          "wrapped_support",
                                          "mesh_hold",
                                          "sound_distance",
                                          "friction_use",
                                          "largest_shape_parameter",
                                          "largest_shape_parameter_at",
                                          "largest_relative_speed",
                                          "largest_relative_speed_at",
                                          "smallest_relative_speed",
                                          "smallest_relative_speed_at",
                                          "sag",
                                          "top_sag",
                                          "thinnest_neck",
                                          "thinnest_neck_at",
                                          "first_contact_at",
                                          "release_x",
                                          "release_y",
                                          "processor_seconds"};
  for (std::size_t i = 0; i < Dwells::most; ++i)
    for (const char* part : {"", "_at", "_from"}) may_be_unknown.insert(dwell_column(i) + part);
  for (const Column& column : columns()) {
    if (column.kind != ValueKind::number) continue;
    const bool means_nothing = !column.applies_to(clogged().parameters);
    std::vector<double> values = {std::nan(""), std::numeric_limits<double>::infinity(), -1e300};
    if (column.role != ColumnRole::parameter) values.push_back(1e300);
    for (const double value : values) {
      if (means_nothing || (std::isnan(value) && may_be_unknown.contains(column.name))) continue;
      std::string fault = fault_with(column, value);
      std::ranges::replace(fault, '-', '_');
      EXPECT_NE(fault.find(column.name), std::string::npos) << column.name << ' ' << value << ": " << fault;
    }
  }
}

TEST(FaultOf, NamesIntegersThatNoParameterHolds) {
  for (const char* name : {"seed", "boxes", "vertices"})
    EXPECT_TRUE(fault_with(column(name), std::int64_t{1} << 40)
                    .starts_with(std::string(name) + "=1099511627776 is out of range, "))
        << name;
  EXPECT_EQ(fault_with(column("seed"), std::int64_t{-5}), "seed=-5 is out of range, 0 to 4294967295");
}

TEST(FaultOf, NamesWhatContradictsTheRest) {
  const std::vector<std::pair<const char*, std::function<void(RunRow&)>>> damages = {
      {"a negative task", [](RunRow& row) { row.task = -2; }},
      {"a negative rank", [](RunRow& row) { row.rank = -1; }},
      {"an attempt before", [](RunRow& row) { row.attempt = 0; }},
      {"boxes=0", [](RunRow& row) { row.parameters.obstacles.boxes = 0; }},
      {"obstacle_density=", [](RunRow& row) { row.obstacle_density *= 16; }},
      {"no droplet gets farther", [](RunRow& row) { row.distance = 1e308; }},
      {"no droplet gets farther", [](RunRow& row) { row.distance = -1e3; }},
      {"no droplet gets farther", [](RunRow& row) { row.lateral = 1e3; }},
      {"is not between 0", [](RunRow& row) { row.time = 2 * row.parameters.max_time; }},
      {"is before", [](RunRow& row) { row.status = RunStatus::flowing; }},
      {"steps do not make", [](RunRow& row) { row.steps = 10; }},
      {"steps do not make", [](RunRow& row) { row.steps = -row.steps; }},
      {"transient=", [](RunRow& row) { row.speed.transient = 2 * row.time; }},
      {"travel_time=", [](RunRow& row) { row.speed.time = -1; }},
      {"mean_speed=", [](RunRow& row) { row.speed.mean = 1e3, row.speed.time = row.time / 2; }},
      {"mean_speed_error=", [](RunRow& row) { row.speed.error = -1e-3; }},
      {"steady_time=", [](RunRow& row) { row.steady = {.distance = 1, .time = row.time}; }},
      {"steady_time=", [](RunRow& row) { row.steady = {.distance = 1, .time = 0}; }},
      {"only one is known", [](RunRow& row) { row.steady = {.distance = 1}; }},
      {"shape_parameter=0.9", [](RunRow& row) { row.shape_parameter = 0.9; }},
      {"shape_parameter=1e6", [](RunRow& row) { row.shape_parameter = 1e6; }},
      {"kinetic_energy_ratio=", [](RunRow& row) { row.kinetic_energy_ratio = 1e9; }},
      {"clogged_by='none'", [](RunRow& row) { row.clogged_by = FoundBy::not_clogged; }},
      {"not clogged", [](RunRow& row) { row.status = RunStatus::interrupted; }},
      {"clog_detection='threshold'",
       [](RunRow& row) { row.parameters.clog_detection = ClogDetection::threshold; }},
      {"kinetic_energy_ratio=", [](RunRow& row) { row.clogged_by = FoundBy::threshold; }},
      {"wrapped_support=", [](RunRow& row) { row.hold.geometry.wrapped_support = 1.5; }},
      {"mesh_hold=", [](RunRow& row) { row.hold.geometry.mesh_hold = -0.1; }},
      {"friction_use=", [](RunRow& row) { row.hold.friction_use = 1.1; }},
      {"not clogged",
       [](RunRow& row) {
         row.hold.friction_use = 0.5, row.status = RunStatus::interrupted, row.clogged_by = {},
         row.stability = {};
       }},
      {"failed_by='crossing'", [](RunRow& row) { row.failed_by = FailedBy::crossing; }},
      {"sound_distance=", [](RunRow& row) { row.sound_distance = 1e3; }},
      {"healed crossings", [](RunRow& row) { row.healed_crossings = -2; }},
      {"number of contacts", [](RunRow& row) { row.hold.geometry.num_gaps = -2; }},
      {"more than a droplet has", [](RunRow& row) { row.hold.geometry.num_wrapped = std::int64_t{1} << 62; }},
      {"model_version=", [](RunRow& row) { row.model_version = -1; }}};
  for (const auto& [words, damage] : damages) {
    RunRow row = clogged();
    damage(row);
    EXPECT_NE(fault_of(row).find(words), std::string::npos) << words << ": " << fault_of(row);
  }
}

/// The final row of a run. The droplet rested twice and ended hanging over an obstacle.
const RunRow& hanging() {
  static const RunRow row = [] {
    RunRow one = row_of({{"max-time", "1000"},
                         {"line-tension", "2"},
                         {"clog-detection", "threshold"},
                         {"clog-energy", "1e-300"}});
    Dwells& dwells = one.dwells;
    const double begin = one.dwells.last_begin;
    dwells.longest[1] = {.length = begin / 2, .distance = dwells.last_distance / 2, .begin = begin / 4};
    dwells.known_from = begin / 4;
    return one;
  }();
  return row;
}

TEST(FaultOf, NamesDwellsThatCannotBe) {
  ASSERT_EQ(fault_of(hanging()), "");
  ASSERT_GT(hanging().dwells.longest[0].length, hanging().dwells.longest[1].length);
  const std::vector<std::pair<const char*, std::function<void(Dwells&)>>> damages = {
      {"only some are known", [](Dwells& dwells) { dwells.known_from = std::nan(""); }},
      {"last_dwell_at=-1 ", [](Dwells& dwells) { dwells.last_distance = -1; }},
      {"last_dwell_from=1001 is not within", [](Dwells& dwells) { dwells.last_begin = 1001; }},
      {"longest_dwell=", [](Dwells& dwells) { dwells.longest[0].length *= 1.1; }},
      {"longest_dwell=nan is not among", [](Dwells& dwells) { dwells.longest[0].length = std::nan(""); }},
      {"longest_dwell_at=", [](Dwells& dwells) { dwells.longest[0].distance = -0.1; }},
      {"longest_dwell_from=-1 ", [](Dwells& dwells) { dwells.longest[0].begin = -1; }},
      {"earlier_dwell_1=", [](Dwells& dwells) { dwells.longest[1].length = 2000; }},
      {"earlier_dwell_1=", [](Dwells& dwells) { dwells.longest[1].length = dwells.known_from; }},
      {"earlier_dwell_1=", [](Dwells& dwells) { dwells.longest[1].begin = dwells.longest[0].begin; }},
      {"earlier_dwell_1=",
       [](Dwells& dwells) { dwells.longest[1].distance = dwells.longest[0].distance + 0.01; }},
      {"earlier_dwell_2=", [](Dwells& dwells) { std::swap(dwells.longest[1], dwells.longest[2]); }}};
  for (const auto& [words, damage] : damages) {
    RunRow row = hanging();
    damage(row.dwells);
    EXPECT_NE(fault_of(row).find(words), std::string::npos) << words << ": " << fault_of(row);
  }
}

TEST(FaultOf, NamesNecksThatCannotBe) {
  RunRow necked = row_of({{"max-time", "5"}, {"line-tension", "0.05"}, {"break-up-neck", "0.05"}});
  necked.neck = {.width = 0.07, .distance = necked.distance / 2};
  ASSERT_EQ(fault_of(necked), "");
  const std::vector<std::pair<const char*, std::function<void(RunRow&)>>> damages = {
      {"only one is known", [](RunRow& row) { row.neck.distance = std::nan(""); }},
      {"thinnest_neck=0.04 is below break_up_neck=0.05, but it has not broken",
       [](RunRow& row) { row.neck.width = 0.04; }},
      {"broken, but thinnest_neck=0.07 is not below break_up_neck=0.05",
       [](RunRow& row) { row.status = RunStatus::broken; }},
      {"broken, but thinnest_neck=nan",
       [](RunRow& row) { row.status = RunStatus::broken, row.neck = ThinnestNeck(); }},
      {"thinnest_neck=0.07 is that of no droplet", [](RunRow& row) { row.parameters.dp.break_up_neck = 0; }},
      {"thinnest_neck=-0.01 is", [](RunRow& row) { row.neck.width = -0.01, row.status = RunStatus::broken; }},
      {"thinnest_neck_at=1000 is not on", [](RunRow& row) { row.neck.distance = 1e3; }}};
  for (const auto& [words, damage] : damages) {
    RunRow row = necked;
    damage(row);
    EXPECT_NE(fault_of(row).find(words), std::string::npos) << words << ": " << fault_of(row);
  }
  necked.status = RunStatus::broken, necked.neck.width = 0.04;
  EXPECT_EQ(fault_of(necked), "");
}

TEST(FaultOf, NamesFamiliesThatCannotBe) {
  const RunRow whole = row_of({{"max-time", "100"},
                               {"line-tension", "0.05"},
                               {"break-up-neck", "0.1"},
                               {"break-up", "daughters"},
                               {"seeds", "5"}});
  ASSERT_GE(whole.family.size(), 3);
  EXPECT_EQ(fault_of(whole), "");
  const auto fault = [&](const auto& change) {
    RunRow row = whole;
    change(row.family);
    return fault_of(row);
  };
  using Family = std::vector<Member>;
  EXPECT_EQ(fault([](Family& family) { family.clear(); }), "its droplets are missing");
  EXPECT_EQ(fault([](Family& family) { family.push_back(family[1]); }), "its droplet 0 occurs twice");
  EXPECT_NE(fault([](Family& family) { family.erase(family.begin() + 1); }), "");
  EXPECT_NE(fault([](Family& family) { family.back().diameter *= 0.99; }), "");
  EXPECT_NE(fault([](Family& family) { family.back().end.time = -1; }), "");
  RunRow in_progress = whole;
  in_progress.status = RunStatus::interrupted;
  in_progress.family.clear();
  EXPECT_EQ(fault_of(in_progress), "") << "the ancestor has broken up, and a daughter moves";
  RunRow without = whole;
  without.parameters.dp.break_up = BreakUp::end;
  EXPECT_EQ(fault_of(without), "it has droplets, but no family");
}

TEST(FaultOf, NamesContactsThatCannotBe) {
  RunRow met = row_of({{"max-time", "5"}});
  met.contacts.number = 2, met.contacts.first_distance = met.distance / 2;
  ASSERT_EQ(fault_of(met), "");
  const std::vector<std::pair<const char*, std::function<void(RunRow&)>>> damages = {
      {"a negative number", [](RunRow& row) { row.contacts.number = -2; }},
      {", but contacts=0", [](RunRow& row) { row.contacts.number = 0; }},
      {"first_contact_at=nan, but contacts=2",
       [](RunRow& row) { row.contacts.first_distance = std::nan(""); }},
      {"first_contact_at=1000 is not on", [](RunRow& row) { row.contacts.first_distance = 1e3; }}};
  for (const auto& [words, damage] : damages) {
    RunRow row = met;
    damage(row);
    EXPECT_NE(fault_of(row).find(words), std::string::npos) << words << ": " << fault_of(row);
  }
}

TEST(FarthestWay, IsHardlyMoreThanAFreeSoftDiskFalls) {
  // No obstacle pushes the disk. Only the weight acts on it.
  RunRow row = describe(plan_of({{"model", "sp"}, {"wall-stiffness", "1"}}).task(0));
  row.parameters.obstacles.gap = std::nan("");
  row.time = 1000;
  EXPECT_NEAR(farthest_distance(row), 1.1 * row.parameters.drag.terminal_speed * row.time, 1e-12);
}

}  // namespace
}  // namespace clog::sweep

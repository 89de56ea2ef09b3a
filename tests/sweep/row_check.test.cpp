#include "clog/sweep/row_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "clog/sweep/plan.hpp"
#include "clog/sweep/run_job.hpp"

namespace clog::sweep {
namespace {

using Keys = std::vector<std::pair<const char*, const char*>>;

Plan plan_of(const Keys& keys) {
  Settings settings;
  for (const auto& [name, text] : Keys{{"box", "20"}, {"seeds", "1"}}) settings.set(name, text);
  for (const auto& [name, text] : keys) settings.set(name, text);
  if (settings.text("model") == "dp") settings.set("vertices", "64");
  return Plan(settings);
}

RunRow row_of(const Keys& keys) {
  const Plan plan = plan_of(keys);
  RunJob job(plan, 0);
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
    {{"max-time", "60"}, {"line-tension", "2"}, {"clog-detection", "threshold"}, {"clog-energy", "1e-5"}},
    {{"max-time", "0.01"}, {"time-step", "3e-3"}},
    {{"max-time", "5"}, {"obstacle-density", "1.2"}, {"obstacle-diameter-spread", "0.3"}},
    {{"max-time", "5"}, {"obstacle-diameter-spread", "0.5"}},
    {{"max-time", "5"}, {"obstacle-layout", "lattice"}, {"box", "60"}, {"obstacle-gap", "1.2"}},
    {{"max-time", "200"}, {"model", "sp"}, {"wall-stiffness", "0.3"}},
    {{"max-time", "200"}, {"model", "sp"}, {"wall-stiffness", "100"}, {"terminal-speed", "100"}},
};

/// A stiff polygon that has clogged: a row that has everything.
const RunRow& clogged() {
  static const RunRow row = row_of(sweeps.front());
  return row;
}

TEST(ParametersOf, AreThoseThatWereDescribed) {
  for (const Keys& keys : sweeps) {
    const RunRow row = describe(plan_of(keys).task(0));
    EXPECT_EQ(identity(describe(parameters_of(row))), identity(row)) << keys[1].first;
  }
}

TEST(FaultOf, NoRowThatAJobGives) {
  for (const Keys& keys : sweeps) EXPECT_EQ(fault_of(row_of(keys)), "") << keys[1].first;
}

TEST(FaultOf, NoRunUnderWay) {
  const Plan plan = plan_of({{"max-time", "1e4"}, {"line-tension", "0.05"}});
  RunJob job(plan, 0);
  EXPECT_EQ(fault_of(job.row()), "");
  for (int i = 0; i < 5; ++i) {
    ASSERT_FALSE(job.advance());
    RunRow row = job.row();
    EXPECT_EQ(fault_of(row), "");
    row.status = "running";
    EXPECT_EQ(fault_of(row), "");
  }
}

TEST(FaultOf, NoRunThatFailed) {
  RunRow row = clogged();
  row.status = "failed";
  row.message = "diverged";
  row.distance = row.shape_parameter = std::nan("");
  EXPECT_EQ(fault_of(row), "");
  row.message = "";
  EXPECT_EQ(fault_of(row), "failed without a reason");
}

TEST(FaultOf, NoColumnThatIsNotKnown) {
  RunRow row = clogged();
  const RunRow unknown;
  row.near_wall_cutoff = unknown.near_wall_cutoff;
  row.contact_range = unknown.contact_range;
  row.self_contact_range = unknown.self_contact_range;
  row.mean_speed_error = unknown.mean_speed_error;
  row.transient = unknown.transient;
  row.travel_time = unknown.travel_time;
  row.mechanism = unknown.mechanism;
  row.wrapped_support = unknown.wrapped_support;
  row.num_wrapped = row.num_gaps = row.num_arcs = -1;
  EXPECT_EQ(fault_of(row), "");
}

TEST(FaultOf, NamesEveryWordThatIsUnknown) {
  const std::vector<std::pair<const char*, std::function<void(RunRow&)>>> damages = {
      {"model", [](RunRow& row) { row.model = "dq"; }},
      {"obstacle_filling", [](RunRow& row) { row.obstacle_filling = "saturatee"; }},
      {"preset", [](RunRow& row) { row.preset = "sobust"; }},
      {"perimeter_spring", [](RunRow& row) { row.perimeter_spring = "alone"; }},
      {"wall_contact", [](RunRow& row) { row.wall_contact = "edgf"; }},
      {"self_contact", [](RunRow& row) { row.self_contact = "off?"; }},
      {"gravity", [](RunRow& row) { row.gravity = "aqea"; }},
      {"clog_detection", [](RunRow& row) { row.clog_detection = "certifiec"; }},
      {"status", [](RunRow& row) { row.status = "cloggee"; }},
      {"clogged_by", [](RunRow& row) { row.clogged_by = "certifiee"; }},
      {"mechanism", [](RunRow& row) { row.mechanism = "srapped"; }}};
  for (const auto& [column, damage] : damages) {
    RunRow row = clogged();
    damage(row);
    EXPECT_EQ(fault_of(row).find(std::string("unknown ") + column), 0u) << column << ": " << fault_of(row);
  }
}

TEST(FaultOf, NamesEveryNumberThatIsNone) {
  const std::vector<std::pair<const char*, double RunRow::*>> columns = {
      {"line-tension", &RunRow::line_tension},
      {"wall_stiffness", &RunRow::wall_stiffness},
      {"obstacle-gap", &RunRow::obstacle_gap},
      {"obstacle-diameter", &RunRow::obstacle_diameter},
      {"obstacle-diameter-spread", &RunRow::obstacle_diameter_spread},
      {"obstacle_density", &RunRow::obstacle_density},
      {"box", &RunRow::box},
      {"time_step", &RunRow::time_step},
      {"max_time", &RunRow::max_time},
      {"terminal_speed", &RunRow::terminal_speed},
      {"near-wall-drag", &RunRow::near_wall_drag},
      {"relative-drag", &RunRow::relative_drag},
      {"area-stiffness", &RunRow::area_stiffness},
      {"perimeter-stiffness", &RunRow::perimeter_stiffness},
      {"wall-tension", &RunRow::wall_tension},
      {"clog-energy", &RunRow::clog_energy},
      {"distance", &RunRow::distance},
      {"lateral_displacement", &RunRow::lateral_displacement},
      {"time", &RunRow::time},
      {"kinetic_energy_ratio", &RunRow::kinetic_energy_ratio},
      {"shape_parameter", &RunRow::shape_parameter},
      {"wall_seconds", &RunRow::wall_seconds}};
  for (const auto& [name, column] : columns)
    for (const double value : {std::nan(""), std::numeric_limits<double>::infinity(), -1e300}) {
      RunRow row = clogged();
      row.*column = value;
      EXPECT_NE(fault_of(row).find(name), std::string::npos) << name << ": " << fault_of(row);
    }
}

TEST(FaultOf, NamesWhatContradictsTheRest) {
  const std::vector<std::pair<const char*, std::function<void(RunRow&)>>> damages = {
      {"a negative task", [](RunRow& row) { row.task = -2; }},
      {"a negative rank", [](RunRow& row) { row.rank = -1; }},
      {"an attempt before", [](RunRow& row) { row.attempt = 0; }},
      {"seed=-5", [](RunRow& row) { row.seed = -5; }},
      {"boxes=0", [](RunRow& row) { row.boxes = 0; }},
      {"boxes=", [](RunRow& row) { row.boxes += std::int64_t{1} << 40; }},
      {"vertices=", [](RunRow& row) { row.vertices += std::int64_t{1} << 40; }},
      {"obstacle_density=", [](RunRow& row) { row.obstacle_density *= 16; }},
      {"no droplet gets farther", [](RunRow& row) { row.distance = 1e308; }},
      {"no droplet gets farther", [](RunRow& row) { row.distance = -1e3; }},
      {"no droplet gets farther", [](RunRow& row) { row.lateral_displacement = 1e3; }},
      {"is not between 0", [](RunRow& row) { row.time = 2 * row.max_time; }},
      {"is before", [](RunRow& row) { row.status = "flowing"; }},
      {"steps do not make", [](RunRow& row) { row.steps = 10; }},
      {"steps do not make", [](RunRow& row) { row.steps = -row.steps; }},
      {"transient=", [](RunRow& row) { row.transient = 2 * row.time; }},
      {"travel_time=", [](RunRow& row) { row.travel_time = -1; }},
      {"mean_speed=", [](RunRow& row) { row.mean_speed = 1e3, row.travel_time = row.time / 2; }},
      {"mean_speed_error=", [](RunRow& row) { row.mean_speed_error = -1e-3; }},
      {"shape_parameter=0.9", [](RunRow& row) { row.shape_parameter = 0.9; }},
      {"shape_parameter=1e+06", [](RunRow& row) { row.shape_parameter = 1e6; }},
      {"kinetic_energy_ratio=", [](RunRow& row) { row.kinetic_energy_ratio = 1e9; }},
      {"clogged_by='none'", [](RunRow& row) { row.clogged_by = "none"; }},
      {"not clogged", [](RunRow& row) { row.status = "interrupted"; }},
      {"clog_detection='threshold'", [](RunRow& row) { row.clog_detection = "threshold"; }},
      {"kinetic_energy_ratio=", [](RunRow& row) { row.clogged_by = "threshold"; }},
      {"wrapped_support=", [](RunRow& row) { row.wrapped_support = 1.5; }},
      {"number of contacts", [](RunRow& row) { row.num_gaps = -2; }}};
  for (const auto& [words, damage] : damages) {
    RunRow row = clogged();
    damage(row);
    EXPECT_NE(fault_of(row).find(words), std::string::npos) << words << ": " << fault_of(row);
  }
}

TEST(FarthestWay, IsHardlyMoreThanAFreeSoftDiskFalls) {
  // No obstacle pushes it, so that it has nothing but its weight.
  RunRow row = describe(plan_of({{"model", "sp"}, {"wall-stiffness", "1"}}).task(0));
  row.obstacle_gap = std::nan("");
  row.time = 1000;
  EXPECT_NEAR(farthest_way(row), 1.1 * row.terminal_speed * row.time, 1e-12);
}

}  // namespace
}  // namespace clog::sweep

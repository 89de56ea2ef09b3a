#include "clog/sweep/run_row.hpp"

#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <utility>

#include "clog/core/error.hpp"
#include "clog/core/instruction_set.hpp"
#include "clog/core/jamming.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::sweep {
namespace {

const char* name(PerimeterSpring spring) {
  switch (spring) {
    case PerimeterSpring::rest:
      return "rest";
    case PerimeterSpring::mean:
      return "mean";
    case PerimeterSpring::along:
      return "along";
  }
  return "unknown";
}

const char* name(Model model) { return model == Model::dp ? "dp" : "sp"; }
const char* name(WallContact contact) { return contact == WallContact::edge ? "edge" : "vertex"; }
const char* name(SelfContact contact) { return contact == SelfContact::on ? "on" : "off"; }
const char* name(Gravity gravity) { return gravity == Gravity::vertex ? "vertex" : "area"; }

/// The one of `all` that is called so.
template <class Enum, std::size_t N>
Enum meant_by(const FixedText<N>& word, const char* column, std::initializer_list<Enum> all) {
  for (const Enum one : all)
    if (word.view() == name(one)) return one;
  throw Error(std::string("unknown ") + column + "='" + std::string(word.view()) + "'");
}

template <class Integer>
Integer in_range(std::int64_t value, const char* column) {
  if (std::in_range<Integer>(value)) return static_cast<Integer>(value);
  throw Error(std::string(column) + '=' + std::to_string(value) + " is out of range");
}

void take_if_known(double value, double& parameter) {
  if (!std::isnan(value)) parameter = value;
}

ObstacleParameters obstacles_of(const RunRow& row) {
  ObstacleParameters obstacles{.gap = row.obstacle_gap,
                               .diameter = row.obstacle_diameter,
                               .diameter_spread = row.obstacle_diameter_spread,
                               .density = {},
                               .box = row.box,
                               .boxes = in_range<int>(row.boxes, "boxes")};
  if (row.obstacle_filling.view() == "density") obstacles.density = row.obstacle_density;
  if (row.obstacle_filling.view() == "lattice") {
    obstacles.layout = ObstacleLayout::lattice;
    obstacles.lattice_angle = row.lattice_angle;
  }
  return obstacles;
}

DpParameters polygon_of(const RunRow& row) {
  DpParameters dp{
      .line_tension = row.line_tension,
      .area_stiffness = row.area_stiffness,
      .perimeter_spring = meant_by(row.perimeter_spring, "perimeter_spring",
                                   {PerimeterSpring::rest, PerimeterSpring::mean, PerimeterSpring::along}),
      .perimeter_stiffness = row.perimeter_stiffness,
      .wall_contact = meant_by(row.wall_contact, "wall_contact", {WallContact::edge, WallContact::vertex}),
      .wall_tension = row.wall_tension,
      .self_contact = meant_by(row.self_contact, "self_contact", {SelfContact::on, SelfContact::off}),
      .gravity = meant_by(row.gravity, "gravity", {Gravity::vertex, Gravity::area}),
      .vertices = in_range<int>(row.vertices, "vertices")};
  take_if_known(row.contact_range, *dp.contact_range);
  take_if_known(row.self_contact_range, dp.self_contact_range);
  return dp;
}

}  // namespace

double density_of(const ObstacleParameters& obstacles) {
  if (obstacles.layout == ObstacleLayout::lattice)
    return 1 / ((obstacles.diameter + obstacles.gap) * (obstacles.diameter + obstacles.gap));
  if (!obstacles.density && obstacles.diameter_spread > 0) return std::numeric_limits<double>::quiet_NaN();
  return obstacles.density.value_or(saturated_density(obstacles.diameter, obstacles.gap));
}

std::string identity(const RunRow& row) {
  // Columns of eight bytes and multiples of them: there are no gaps.
  constexpr std::size_t begin = offsetof(RunRow, model);
  constexpr std::size_t end = offsetof(RunRow, status);
  return {reinterpret_cast<const char*>(&row) + begin, end - begin};
}

RunRow describe(const RunParameters& run) {
  constexpr double not_applicable = std::numeric_limits<double>::quiet_NaN();
  const bool polygon = run.model == Model::dp;
  const ObstacleParameters& obstacles = run.obstacles;
  RunRow row;
  row.model = name(run.model);
  row.line_tension = polygon ? run.dp.line_tension : not_applicable;
  row.wall_stiffness = run.wall_stiffness.value();
  row.obstacle_gap = obstacles.gap;
  row.obstacle_diameter = obstacles.diameter;
  row.obstacle_diameter_spread = obstacles.diameter_spread;
  row.obstacle_density = density_of(obstacles);
  row.obstacle_filling = obstacles.layout == ObstacleLayout::lattice ? "lattice"
                         : obstacles.density                         ? "density"
                                                                     : "saturated";
  row.lattice_angle = obstacles.layout == ObstacleLayout::lattice ? obstacles.lattice_angle : not_applicable;
  row.box = obstacles.box;
  row.boxes = obstacles.boxes;
  row.seed = run.seed;
  row.vertices = polygon ? run.dp.vertices : 1;
  row.time_step = *run.time_step;
  row.max_time = run.max_time;
  row.terminal_speed = run.drag.terminal_speed;
  row.near_wall_drag = run.drag.near_wall;
  row.area_stiffness = polygon ? *run.dp.area_stiffness : not_applicable;
  row.near_wall_exponent = polygon ? run.drag.near_wall_exponent : not_applicable;
  row.near_wall_cutoff = polygon ? run.drag.near_wall_cutoff : not_applicable;
  row.relative_drag = run.drag.relative;
  row.preset = polygon ? preset_name(run) : "none";
  row.perimeter_spring = polygon ? name(run.dp.perimeter_spring) : "none";
  row.wall_contact = polygon ? name(run.dp.wall_contact) : "none";
  row.contact_range = polygon ? run.dp.contact_range.value() : not_applicable;
  row.wall_tension = polygon ? run.dp.wall_tension : not_applicable;
  row.perimeter_stiffness = polygon ? run.dp.perimeter_stiffness.value() : not_applicable;
  row.self_contact = polygon ? name(run.dp.self_contact) : "none";
  row.self_contact_range = polygon ? run.dp.self_contact_range : not_applicable;
  row.gravity = polygon ? name(run.dp.gravity) : "none";
  row.clog_energy = run.clog_energy;
  row.instruction_set = polygon ? instruction_set() : "none";
  row.clog_detection = clog::name(run.clog_detection);
  row.model_version = model_version;
  return row;
}

RunParameters parameters_of(const RunRow& row) {
  RunParameters run;
  run.model = meant_by(row.model, "model", {Model::dp, Model::sp});
  run.wall_stiffness = row.wall_stiffness;
  run.obstacles = obstacles_of(row);
  run.drag.terminal_speed = row.terminal_speed;
  run.drag.near_wall = row.near_wall_drag;
  run.drag.relative = row.relative_drag;
  run.time_step = row.time_step;
  run.max_time = row.max_time;
  run.clog_energy = row.clog_energy;
  run.clog_detection =
      meant_by(row.clog_detection, "clog_detection", {ClogDetection::certified, ClogDetection::threshold});
  run.seed = in_range<std::uint32_t>(row.seed, "seed");
  if (run.model == Model::sp) return run;
  run.dp = polygon_of(row);
  run.drag.near_wall_exponent = row.near_wall_exponent;
  take_if_known(row.near_wall_cutoff, run.drag.near_wall_cutoff);
  return run;
}

void record(const RunResult& result, RunRow& row) {
  row.status = std::string_view(clog::name(result.status));
  row.clogged_by = result.clogged_by ? clog::name(*result.clogged_by) : "none";
  row.distance = result.distance;
  row.lateral_displacement = result.lateral;
  row.time = result.time;
  row.mean_speed = result.speed.mean;
  row.mean_speed_error = result.speed.error;
  row.transient = result.speed.transient;
  row.travel_time = result.speed.time;
  row.kinetic_energy_ratio = result.kinetic_energy_ratio;
  row.shape_parameter = result.shape_parameter;
  row.mechanism = clog::name(result.mechanism);
  row.wrapped_support = result.geometry.wrapped_support;
  row.num_wrapped = result.geometry.num_wrapped;
  row.num_gaps = result.geometry.num_gaps;
  row.num_arcs = result.geometry.num_arcs;
  row.steps = result.steps;
  row.message = result.message;
}

}  // namespace clog::sweep

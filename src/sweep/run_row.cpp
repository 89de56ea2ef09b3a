#include "clog/sweep/run_row.hpp"

#include <cstddef>
#include <limits>

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

/// Obstacles per sigma^2; NaN for a saturated mixture, whose jamming limit is not known beforehand.
double density_of(const ObstacleParameters& obstacles) {
  if (obstacles.layout == ObstacleLayout::lattice)
    return 1 / ((obstacles.diameter + obstacles.gap) * (obstacles.diameter + obstacles.gap));
  if (!obstacles.density && obstacles.diameter_spread > 0) return std::numeric_limits<double>::quiet_NaN();
  return obstacles.density.value_or(saturated_density(obstacles.diameter, obstacles.gap));
}

}  // namespace

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
  row.model = polygon ? "dp" : "sp";
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
  row.wall_contact = !polygon ? "none" : run.dp.wall_contact == WallContact::edge ? "edge" : "vertex";
  row.contact_range = polygon ? run.dp.contact_range.value() : not_applicable;
  row.wall_tension = polygon ? run.dp.wall_tension : not_applicable;
  row.perimeter_stiffness = polygon ? run.dp.perimeter_stiffness.value() : not_applicable;
  row.self_contact = !polygon ? "none" : run.dp.self_contact == SelfContact::on ? "on" : "off";
  row.self_contact_range = polygon ? run.dp.self_contact_range : not_applicable;
  row.gravity = !polygon ? "none" : run.dp.gravity == Gravity::vertex ? "vertex" : "area";
  row.clog_energy = run.clog_energy;
  row.instruction_set = polygon ? instruction_set() : "none";
  row.clog_detection = clog::name(run.clog_detection);
  row.model_version = model_version;
  return row;
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

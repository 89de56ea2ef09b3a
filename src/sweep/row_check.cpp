#include "clog/sweep/row_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <set>
#include <string_view>

#include "clog/core/droplet.hpp"
#include "clog/core/error.hpp"
#include "clog/core/stability.hpp"
#include "clog/core/units.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::sweep {
namespace {

using Words = std::set<std::string_view>;

/// Round-off of a sum of time steps, and of a polygon's perimeter and area.
constexpr double round_off = 1e-9;

bool is_number_below(double value, double bound) { return std::isfinite(value) && std::abs(value) <= bound; }

std::string named(const char* column, double value) { return std::string(column) + '=' + shortest(value); }
std::string named(const char* column, std::string_view word) {
  return std::string(column) + "='" + std::string(word) + "'";
}

bool is_sampled(const RunRow& row) {
  return Words{"saturated", "density", "lattice"}.contains(row.obstacle_filling.view());
}

/// The other words of what was run are read by parameters_of().
std::string unknown_word(const RunRow& row) {
  struct Column {
    const char* name;
    std::string_view word;
    Words known;
  };
  const std::array<Column, 7> columns{
      {{"model", row.model.view(), {"dp", "sp"}},
       {"obstacle_filling",
        row.obstacle_filling.view(),
        {"saturated", "density", "lattice", "file", "channel", "wall"}},
       {"preset", row.preset.view(), {"robust", "heavy-interface", "elastic", "literal", "custom", "none"}},
       {"status", row.status.view(), {"clogged", "flowing", "passed", "failed", "running", "interrupted"}},
       {"clogged_by", row.clogged_by.view(), {"certified", "threshold", "none", ""}},
       {"mechanism", row.mechanism.view(), {"wrapped", "squeezed", "hybrid", "none", ""}},
       {"clog_detection", row.clog_detection.view(), {"certified", "threshold"}}}};
  for (const Column& column : columns)
    if (!column.known.contains(column.word)) return "unknown " + named(column.name, column.word);
  return "";
}

/// Refuses a row whose parameters cannot be run: resolve() knows which can. @throws Error
RunParameters resolved_parameters(const RunRow& row) {
  RunParameters run = parameters_of(row);
  // A lattice's box and angle are those used; to look for the nearest lattice once more would take long.
  const ObstacleParameters used = run.obstacles;
  if (used.layout == ObstacleLayout::lattice && !(std::abs(used.lattice_angle) <= 45))
    throw Error(named("lattice_angle", used.lattice_angle) + " is not within 45 degrees");
  run.obstacles.layout = ObstacleLayout::random;
  run.obstacles.lattice_angle = 0;
  run = resolve(run);
  run.obstacles = used;
  return run;
}

/// Rules are those of this program's model.
std::string parameter_fault(const RunRow& row) {
  for (const auto& [name, value] : {std::pair{"time_step", row.time_step},
                                    {"max_time", row.max_time},
                                    {"terminal_speed", row.terminal_speed},
                                    {"wall_stiffness", row.wall_stiffness}})
    if (!(std::isfinite(value) && value > 0)) return named(name, value) + " is not positive";
  if (row.model_version != model_version || !is_sampled(row)) return "";
  try {
    const double density = density_of(resolved_parameters(row).obstacles);
    const bool agrees = std::isnan(density) ? std::isnan(row.obstacle_density)
                                            : std::abs(row.obstacle_density - density) <= round_off * density;
    return agrees ? "" : named("obstacle_density", row.obstacle_density) + " is not that of its array";
  } catch (const Error& error) {
    return error.what();
  }
}

std::string bookkeeping_fault(const RunRow& row) {
  if (row.task < 0) return "a negative task";
  if (row.rank < 0) return "a negative rank";
  if (row.attempt < 1) return "an attempt before the first";
  if (!(std::isfinite(row.wall_seconds) && row.wall_seconds >= 0))
    return named("wall_seconds", row.wall_seconds) + " is no time";
  return "";
}

/// Runs end after a whole number of steps.
std::string time_fault(const RunRow& row) {
  if (!(row.time >= 0 && row.time <= (1 + round_off) * row.max_time + row.time_step))
    return named("time", row.time) + " is not between 0 and " + named("max_time", row.max_time);
  if (row.status.view() == "flowing" && row.time < (1 - round_off) * row.max_time - row.time_step)
    return "flowing, but " + named("time", row.time) + " is before " + named("max_time", row.max_time);
  const double steps = row.time / row.time_step;
  const auto integrated = static_cast<double>(row.steps);
  if (!(integrated >= (1 - round_off) * steps - 0.5 &&
        integrated <= most_substeps * ((1 + round_off) * steps + 0.5)))
    return std::to_string(row.steps) + " steps do not make " + named("time", row.time);
  return "";
}

/// What a droplet may have been released with [g rho sigma^3], beyond what it has when it is free.
double released_energy(const RunRow& row) {
  if (row.model.view() == "sp") {
    // As many obstacles as find room in its reach, each pushed in by no more than its centre.
    const double spacing = row.obstacle_diameter * (1 - row.obstacle_diameter_spread) + row.obstacle_gap;
    const double across = (units::droplet_diameter + row.obstacle_diameter + spacing) / spacing;
    return std::isnan(across) ? 0 : across * across * row.wall_stiffness / 2;
  }
  // The interface of a droplet released among obstacles is longer than a circle; it gets hardly twice as
  // long.
  constexpr double excess_perimeter = 20;  // [sigma]
  const double spring = row.perimeter_spring.view() == "along" ? 0 : row.perimeter_stiffness;
  return excess_perimeter * (row.line_tension + spring * excess_perimeter / 2);
}

std::string motion_fault(const RunRow& row) {
  const double farthest = farthest_way(row);
  if (!is_number_below(std::hypot(row.distance, row.lateral_displacement), farthest))
    return named("distance", row.distance) + ", " + named("lateral_displacement", row.lateral_displacement) +
           ": no droplet gets farther than " + shortest(farthest) + " in " + named("time", row.time);
  const double slightly_more = (1 + round_off) * row.time;
  if (!std::isnan(row.transient) && !(row.transient >= 0 && row.transient <= slightly_more))
    return named("transient", row.transient) + " is not within the run";
  if (!std::isnan(row.travel_time) && !(row.travel_time > 0 && row.travel_time <= slightly_more))
    return named("travel_time", row.travel_time) + " is not within the run";
  if (!std::isnan(row.mean_speed) && !std::isnan(row.travel_time) &&
      !is_number_below(row.mean_speed * row.travel_time, 2 * farthest))
    return named("mean_speed", row.mean_speed) + " is faster than a droplet can be";
  if (!std::isnan(row.mean_speed_error) &&
      !(std::isfinite(row.mean_speed_error) && row.mean_speed_error >= 0))
    return named("mean_speed_error", row.mean_speed_error) + " is no error";
  return "";
}

/// Of a droplet that has moved: before that its shape is not known.
std::string shape_fault(const RunRow& row) {
  if (row.steps == 0) return "";
  if (!(row.kinetic_energy_ratio >= 0 && row.kinetic_energy_ratio < diverged_energy_ratio))
    return named("kinetic_energy_ratio", row.kinetic_energy_ratio) + " is that of no run that is whole";
  const double most = burst_perimeter * burst_perimeter /
                      (4 * std::numbers::pi * units::rest_area * (1 - diverged_area_error));
  if (!(row.shape_parameter >= 1 - round_off && row.shape_parameter < most))
    return named("shape_parameter", row.shape_parameter) + " is that of no droplet";
  return "";
}

std::string clog_fault(const RunRow& row) {
  const std::string_view by = row.clogged_by.view();
  const bool is_clogged = row.status.view() == "clogged";
  if (is_clogged && by == "none") return "clogged, but clogged_by='none'";
  if (!is_clogged && by != "none" && !by.empty()) return named("clogged_by", by) + ", but it is not clogged";
  if (by == "certified" && row.clog_detection.view() == "threshold")
    return "clogged_by='certified', but clog_detection='threshold'";
  if (by == "threshold" && row.kinetic_energy_ratio >= row.clog_energy)
    return "clogged_by='threshold', but " + named("kinetic_energy_ratio", row.kinetic_energy_ratio);
  if (!is_clogged && row.mechanism.view() != "none" && !row.mechanism.view().empty())
    return named("mechanism", row.mechanism.view()) + ", but it is not clogged";
  if (!std::isnan(row.wrapped_support) &&
      !(is_clogged && row.wrapped_support >= 0 && row.wrapped_support <= 1 + round_off))
    return named("wrapped_support", row.wrapped_support) + " is no share of a clog's support";
  if (std::min({row.num_wrapped, row.num_gaps, row.num_arcs}) < -1) return "a negative number of contacts";
  return "";
}

std::string result_fault(const RunRow& row) {
  if (row.status.view() == "failed") return row.message.view().empty() ? "failed without a reason" : "";
  for (const auto check : {time_fault, motion_fault, shape_fault, clog_fault})
    if (std::string fault = check(row); !fault.empty()) return fault;
  return "";
}

}  // namespace

double farthest_way(const RunRow& row) {
  // Springs along the interface have no energy; a tenth more is for the little work that they do.
  constexpr double margin = 1.1;
  const double weight = units::droplet_mass * units::gravity;
  return margin * (row.terminal_speed * row.time + released_energy(row) / weight);
}

std::string fault_of(const RunRow& row) {
  for (const auto check : {unknown_word, bookkeeping_fault, parameter_fault, result_fault})
    if (std::string fault = check(row); !fault.empty()) return fault;
  return "";
}

}  // namespace clog::sweep

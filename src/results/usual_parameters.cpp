#include "clog/results/usual_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "clog/core/parameters/schema.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::results {
namespace {

/// The row's model and preset, and defaults for all other keys; not resolved.
RunParameters defaults_for(const sweep::RunRow& row) {
  sweep::Settings settings;
  settings.set("model", name(row.parameters.model));
  if (row.preset != "none" && row.preset != "custom") settings.set("preset", row.preset);
  RunParameters run;
  for (const sweep::Key& key : sweep::keys()) key.apply(run, settings.values(key.name).front());
  if (run.model == Model::sp) run.wall_stiffness = row.parameters.wall_stiffness;
  return run;
}

bool are_circles_missing(const RunParameters& run) {
  return scene_of(run).walls_from == WallsFrom::circles &&
         !(run.obstacles.own && run.obstacles.own->are_known());
}

/// Whether the column's key applies only to user-supplied circles, so that a row of the default layout lacks
/// a value.
bool is_of_own_circles(const sweep::Column& column, const RunParameters& run) {
  return scene_of(run).walls_from == WallsFrom::circles && column.parameter &&
         column.parameter->applies_to(run) && !column.parameter->applies_to(RunParameters());
}

/// The default density. A share of the saturated density is a different number for each gap and diameter.
Value usual_density(RunParameters run) {
  run.obstacles.density = ObstacleParameters().density;
  return sweep::describe(resolve(run)).obstacle_density;
}

/// Whether the array's density follows from gaps, diameters or circles.
bool has_derived_density(const sweep::RunRow& row) {
  const ObstacleParameters& obstacles = row.parameters.obstacles;
  return obstacles.layout != ObstacleLayout::random ||
         (!obstacles.density.per_area && !obstacles.density.share);
}

enum class Others { all, independent };

/// Whether the value is automatic for the row's other parameters: for all of them, or for those that do not
/// follow from this value.
bool is_automatic_with(Others others, const sweep::Column& column, const sweep::RunRow& row) try {
  if (!column.may_be_automatic(row.parameters)) return false;
  if (are_circles_missing(row.parameters)) return true;  // unknown without the circles
  RunParameters run = defaults_for(row);
  for (const Parameter& parameter : parameter_schema())
    if (&parameter != column.parameter && (parameter.shapes_array || parameter.has_own_column) &&
        (others == Others::all || !parameter.may_follow_from(*column.parameter)))
      parameter.set(run, parameter.get(row.parameters));
  run.obstacles.own = row.parameters.obstacles.own;  // with the circles
  return column.get(sweep::describe(resolve(run))) == column.get(row);
} catch (const Error&) {
  return false;
}

/// Whether all values that may follow from the column's value follow from the row's other values.
bool are_followers_automatic(const sweep::Column& column, const sweep::RunRow& row) {
  return std::ranges::all_of(sweep::columns(), [&](const sweep::Column& other) {
    return !other.parameter || !other.parameter->may_follow_from(*column.parameter) ||
           is_automatic_with(Others::all, other, row);
  });
}

}  // namespace

bool is_automatic(const sweep::Column& column, const sweep::RunRow& row) {
  // The time step follows from a given stiffness of walls, and an automatic stiffness from the time step.
  return is_automatic_with(Others::independent, column, row) ||
         (is_automatic_with(Others::all, column, row) && !are_followers_automatic(column, row));
}

bool has_parameter(const sweep::Column& column, const RunParameters& run) {
  if (column.name == "preset") return run.model == Model::dp;
  return !column.parameter || column.parameter->applies_to(run);
}

Value separating_value(const sweep::Column& column, const sweep::RunRow& row) {
  if (column.name == "obstacle_density" && has_derived_density(row)) return {};
  if (column.parameter && !column.parameter->applies_to(row.parameters)) return {};
  if (is_automatic(column, row)) return {};
  const DpParameters& dp = row.parameters.dp;
  if (column.name == "perimeter_stiffness" && dp.perimeter_spring == PerimeterSpring::rest &&
      dp.perimeter_stiffness && dp.line_tension > 0) {
    constexpr double figures = 1e9;  // the ratio has round-off
    return std::round(figures * *dp.perimeter_stiffness / dp.line_tension) / figures;
  }
  return column.get(row);
}

std::vector<Value> usual_parameters(const sweep::RunRow& row) try {
  const RunParameters& run = row.parameters;
  std::vector<Value> usual = parameter_values(sweep::describe(resolve(defaults_for(row))));
  for (std::size_t i = 0; i < usual.size(); ++i) {
    const sweep::Column& column = *group_columns()[i];
    if (column.name == "obstacle_density")
      usual[i] = run.obstacles.density.per_area ? usual_density(run) : column.get(row);
    if (is_of_own_circles(column, run)) usual[i] = column.parameter->get(RunParameters());
    if (column.may_be_automatic(run)) usual[i] = is_automatic(column, row) ? column.get(row) : Value();
  }
  return usual;
} catch (const Error&) {
  return {};
}

}  // namespace clog::results

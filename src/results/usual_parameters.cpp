#include "clog/results/usual_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clog/core/parameters/schema.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::results {
namespace {

/// Model and preset of the row, all else by default; not resolved yet.
RunParameters defaults_for(const sweep::RunRow& row) {
  sweep::Settings settings;
  settings.set("model", name(row.parameters.model));
  if (row.preset != "none" && row.preset != "custom") settings.set("preset", row.preset);
  RunParameters run;
  for (const sweep::Key& key : sweep::keys()) key.apply(run, settings.values(key.name).front());
  if (run.model == Model::sp) run.wall_stiffness = row.parameters.wall_stiffness;
  return run;
}

/// The row's parameters, but with its preset's values for those that may be automatic.
RunParameters with_usual_values(const sweep::RunRow& row) {
  RunParameters run = defaults_for(row);
  for (const Parameter& parameter : parameter_schema())
    if (parameter.shapes_array || (parameter.has_own_column && !parameter.may_be_automatic(run)))
      parameter.set(run, parameter.get(row.parameters));
  return run;
}

bool are_circles_missing(const RunParameters& run) {
  return scene_of(run).walls_from == WallsFrom::circles &&
         !(run.obstacles.own && run.obstacles.own->are_known());
}

/// A row may have only the checksum of user-supplied circles; automatic values hardly depend on them.
RunParameters resolved_in_any_layout(RunParameters run) {
  if (!are_circles_missing(run)) return resolve(run);
  const ObstacleParameters own = run.obstacles;
  // Resolved in a generated array, which the box and the gap of the device might not allow.
  run.obstacles = {.diameter = own.diameter};
  run = resolve(run);
  run.obstacles = own;
  return run;
}

/// A key of user-supplied circles alone, which a row of the default layout says nothing about.
bool is_of_own_circles(const sweep::Column& column, const RunParameters& run) {
  return scene_of(run).walls_from == WallsFrom::circles && column.parameter &&
         column.parameter->applies_to(run) && !column.parameter->applies_to(RunParameters());
}

/// The density of these arrays follows from gaps, diameters or circles.
bool has_derived_density(const sweep::RunRow& row) {
  const ObstacleParameters& obstacles = row.parameters.obstacles;
  return obstacles.layout != ObstacleLayout::random ||
         (!obstacles.density.per_area && !obstacles.density.share);
}

/// Do automatic values of the one parameter follow from the other? The step follows from the vertices, the
/// stiffness of walls from both.
bool follows(const Parameter& one, const Parameter& other) {
  constexpr std::string_view chain[] = {"vertices", "time-step", "wall-stiffness"};
  const auto* place = std::ranges::find(chain, std::string_view(one.key));
  return std::find(std::begin(chain), place, std::string_view(other.key)) != place &&
         place != std::end(chain);
}

}  // namespace

bool is_automatic(const sweep::Column& column, const sweep::RunRow& row) try {
  if (!column.may_be_automatic(row.parameters)) return false;
  if (are_circles_missing(row.parameters)) return true;  // as far as anybody can tell
  const auto is_automatic_with = [&](const auto& are_given) {
    RunParameters run = defaults_for(row);
    for (const Parameter& parameter : parameter_schema())
      if (&parameter != column.parameter && (parameter.shapes_array || parameter.has_own_column) &&
          are_given(parameter))
        parameter.set(run, parameter.get(row.parameters));
    run.obstacles.own = row.parameters.obstacles.own;  // the circles, too
    return column.get(sweep::describe(resolved_in_any_layout(run))) == column.get(row);
  };
  return is_automatic_with([](const Parameter&) { return true; }) ||
         is_automatic_with([&](const Parameter& other) { return !follows(other, *column.parameter); });
} catch (const Error&) {
  return false;
}

Value separating_value(const sweep::Column& column, const sweep::RunRow& row) {
  if (column.name == "obstacle_density" && has_derived_density(row)) return {};
  if (column.parameter && !column.parameter->applies_to(row.parameters)) return {};
  if (is_automatic(column, row)) return {};
  const DpParameters& dp = row.parameters.dp;
  if (column.name == "perimeter_stiffness" && dp.perimeter_spring == PerimeterSpring::rest &&
      dp.perimeter_stiffness && dp.line_tension > 0) {
    constexpr double figures = 1e9;  // the ratio is known to round-off only
    return std::round(figures * *dp.perimeter_stiffness / dp.line_tension) / figures;
  }
  return column.get(row);
}

std::vector<Field> usual_parameters(const sweep::RunRow& row) try {
  const auto fields_of = [](RunParameters run) {
    return parameter_fields(sweep::describe(resolved_in_any_layout(std::move(run))));
  };
  // One automatic value follows from the other: the step from the vertices, the stiffness of walls from both.
  RunParameters run = with_usual_values(row);
  const std::vector<Field> with_usual_vertices = fields_of(run);
  run.dp.vertices = row.parameters.dp.vertices;
  const std::vector<Field> with_usual_step = fields_of(run);
  run.time_step = row.parameters.time_step;
  const std::vector<Field> with_own_step = fields_of(run);
  // A share of the saturated density is another number for each gap and diameter.
  RunParameters filled_as_usual = run;
  filled_as_usual.obstacles.density = ObstacleParameters().density;
  const std::vector<Field> with_usual_density = fields_of(filled_as_usual);
  std::vector<Field> usual = fields_of(defaults_for(row));
  for (std::size_t i = 0; i < usual.size(); ++i) {
    const sweep::Column& column = *group_columns()[i];
    if (column.name == "obstacle_density")
      usual[i] = (run.obstacles.density.per_area ? with_usual_density : with_own_step)[i];
    if (is_of_own_circles(column, run)) usual[i].second = column.parameter->get(RunParameters());
    if (!column.may_be_automatic(run)) continue;
    usual[i] = (column.name == "vertices"    ? with_usual_vertices
                : column.name == "time_step" ? with_usual_step
                                             : with_own_step)[i];
  }
  return usual;
} catch (const Error&) {
  return {};
}

}  // namespace clog::results

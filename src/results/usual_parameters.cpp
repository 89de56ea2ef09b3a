#include "clog/results/usual_parameters.hpp"

#include <algorithm>
#include <vector>

#include "clog/core/parameters/schema.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::results {
namespace {

/// Unresolved parameters: the row's model and preset, and defaults for all other keys.
RunParameters defaults_for(const sweep::RunRow& row) {
  sweep::Settings settings;
  settings.set("model", name(row.parameters.model));
  if (sweep::has_named_preset(row)) settings.set("preset", row.preset);
  RunParameters run;
  for (const sweep::Key& key : sweep::keys()) key.apply(run, settings.values(key.name).front());
  if (run.model == Model::sp) run.wall_stiffness = row.parameters.wall_stiffness;
  return run;
}

bool are_circles_missing(const RunParameters& run) {
  return scene_of(run).walls_from == WallsFrom::circles &&
         !(run.obstacles.own && run.obstacles.own->are_known());
}

/// Whether the column's key applies only to user-supplied circles, so that rows of the default layout have no
/// value.
bool is_of_own_circles(const sweep::Column& column, const RunParameters& run) {
  return scene_of(run).walls_from == WallsFrom::circles && column.parameter &&
         column.parameter->applies_to(run) && !column.parameter->applies_to(RunParameters());
}

enum class Others { all, independent };

/// Whether `auto` would give the row's value in this column. The automatic value is computed either from all
/// other parameters of the row, or only from the parameters that do not follow from the column's value.
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

/// Whether all parameters that may follow from the column's value have their automatic value in this row.
bool are_followers_automatic(const sweep::Column& column, const sweep::RunRow& row) {
  return std::ranges::all_of(sweep::columns(), [&](const sweep::Column& other) {
    return !other.parameter || !other.parameter->may_follow_from(*column.parameter) ||
           is_automatic_with(Others::all, other, row);
  });
}

}  // namespace

bool is_automatic(const sweep::Column& column, const sweep::RunRow& row) {
  // Time step and wall stiffness may follow from each other: the step from a given stiffness, an automatic
  // stiffness from the step.
  return is_automatic_with(Others::independent, column, row) ||
         (is_automatic_with(Others::all, column, row) && !are_followers_automatic(column, row));
}

Value separating_value(const sweep::Column& column, const sweep::RunRow& row) {
  if (!column.applies_to(row.parameters) || is_automatic(column, row)) return {};
  if (column.compared) return column.compared(row);
  const bool has_rule = column.parameter && column.parameter->compared;
  const Value value = has_rule ? column.parameter->compared(row.parameters) : Value();
  return value == Value() ? column.get(row) : value;
}

std::vector<Value> usual_parameters(const sweep::RunRow& row) try {
  const RunParameters& run = row.parameters;
  std::vector<Value> usual = parameter_values(sweep::describe(resolve(defaults_for(row))));
  for (std::size_t i = 0; i < usual.size(); ++i) {
    const sweep::Column& column = *group_columns()[i];
    if (column.usual) usual[i] = column.usual(row);
    if (is_of_own_circles(column, run)) usual[i] = column.parameter->get(RunParameters());
    if (column.may_be_automatic(run)) usual[i] = is_automatic(column, row) ? column.get(row) : Value();
  }
  return usual;
} catch (const Error&) {
  return {};
}

}  // namespace clog::results

#include "usual_parameters.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>

#include "clog/core/error.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/run_row.hpp"
#include "clog/sweep/settings.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog {
namespace {

/// Columns whose values may follow from the others, and their keys.
const std::set<std::string_view> automatic = {"time_step", "area_stiffness", "perimeter_stiffness",
                                              "wall_stiffness", "obstacle_density"};

bool is_automatic(std::string_view column, const sweep::RunRow& row) {
  if (column == "wall_stiffness") return row.model.view() == "dp";
  if (column == "obstacle_density") return row.obstacle_filling.view() != "density";
  return automatic.contains(column);
}

std::string text_of(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return sweep::shortest(*number);
  if (const auto* count = std::get_if<std::int64_t>(&value)) return std::to_string(*count);
  return std::get<std::string>(value);
}

std::vector<Field> fields_of(const sweep::Settings& settings) {
  return parameter_fields(sweep::describe(sweep::Plan(settings).task(0)));
}

/// Model and preset of the row, all else by default.
sweep::Settings defaults_for(const sweep::RunRow& row) {
  sweep::Settings settings;
  settings.set("model", std::string(row.model.view()));
  if (row.model.view() == "sp") settings.set("wall-stiffness", sweep::shortest(row.wall_stiffness));
  if (const std::string preset(row.preset.view()); preset != "none" && preset != "custom")
    settings.set("preset", preset);
  return settings;
}

/// Sets the key that a column belongs to, if there is one and it means something to the row.
void set_key(sweep::Settings& settings, std::string_view column, const std::string& text,
             const sweep::RunRow& row) {
  if (is_automatic(column, row) || text.empty() || text == "none" || text == "custom") return;
  std::string name(column);
  std::replace(name.begin(), name.end(), '_', '-');
  for (const sweep::Key& key : sweep::keys())
    if (key.name == name && !(key.dp_only && row.model.view() == "sp")) settings.set(name, text);
}

}  // namespace

std::vector<Field> usual_parameters(const sweep::RunRow& row) try {
  sweep::Settings settings = defaults_for(row);
  std::vector<Field> usual = fields_of(settings);
  if (row.obstacle_filling.view() == "lattice") settings.set("obstacle-layout", "lattice");
  for (const auto& [column, value] : parameter_fields(row)) set_key(settings, column, text_of(value), row);
  const std::vector<Field> with_usual_step = fields_of(settings);
  settings.set("time-step", sweep::shortest(row.time_step));  // the stiffness of walls follows from it
  const std::vector<Field> with_own_step = fields_of(settings);
  for (std::size_t i = 0; i < usual.size(); ++i)
    if (const std::string_view column = usual[i].first; is_automatic(column, row))
      usual[i] = (column == "time_step" ? with_usual_step : with_own_step)[i];
  return usual;
} catch (const Error&) {
  return {};
}

}  // namespace clog

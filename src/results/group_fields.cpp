#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/units.hpp"
#include "clog/core/world/lattice.hpp"
#include "clog/results/groups.hpp"
#include "value_json.hpp"

namespace clog::results {
namespace {

Value value_of(double number) { return std::isnan(number) ? Value() : Value(number); }
Value value_of(int count) { return std::int64_t{count}; }

bool has_role(const sweep::Column& column, ParameterRole role) {
  return column.parameter && column.parameter->role == role;
}

/// Appends the number of runs that each cause ended, and the lengths; all are unset if the causes are
/// unknown.
void append_causes(const Group& group, std::vector<Field>& fields) {
  const bool are_known = !group.causes.empty();
  const auto add = [&](const std::string& name, auto number) {
    fields.emplace_back(name, are_known ? value_of(number) : Value());
  };
  for (std::size_t i = 0; i < std::size(cause_texts); ++i) {
    const fit::CloggingLength fit = are_known ? group.causes[i].ends : fit::CloggingLength();
    const std::string length = cause_texts[i].length;
    add(cause_texts[i].count, fit.num_clogs);
    add(length, fit.length);
    add(length + "_lower", fit.interval.lower);
    add(length + "_upper", fit.interval.upper);
  }
}

constexpr std::pair<std::string_view, std::string_view> units_of_results[] = {
    {"dwell", "t0"},
    {"row_angle", "degrees"},
    {"pitch", "sigma"},
    {"row_spacing", "sigma"},
    {"total_distance", "sigma"},
    {"contacts_per_length", "1/sigma"},
    {"failures_per_length", "1/sigma"},
    {"relative_speed", "v_t"},
    {"relative_speed_error", "v_t"},
    {"relative_speed_all", "v_t"},
    {"relative_speed_all_error", "v_t"},
    {"relative_speed_pooled", "v_t"},
    {"relative_speed_pooled_error", "v_t"},
    {"relative_speed_steady", "v_t"},
    {"relative_speed_steady_error", "v_t"}};

}  // namespace

std::string_view unit_of(std::string_view field) {
  if (field.ends_with("_mm")) return "mm";
  if (field.ends_with("_mN_per_m")) return "mN/m";
  if (field.ends_with("_mm_per_s")) return "mm/s";
  if (field == "time_to_clog_s") return "s";
  if (field.starts_with("clogging_length") || field.starts_with("break_up_length")) return "sigma";
  for (const auto& [name, unit] : units_of_results)
    if (name == field) return unit;
  for (const sweep::Column& column : sweep::columns())
    if (column.name == field) return column.unit;
  return "";
}

std::span<const sweep::Column* const> group_columns() {
  static const std::vector<const sweep::Column*> all = [] {
    std::vector<const sweep::Column*> columns;
    for (const sweep::Column& column : sweep::columns())
      if (column.role == sweep::ColumnRole::parameter && !has_role(column, ParameterRole::ensemble))
        columns.push_back(&column);
    std::ranges::stable_sort(columns.begin() + 1, columns.end(), {}, [](const sweep::Column* column) {
      return std::pair(has_role(*column, ParameterRole::numerics), !column->shapes_array);
    });
    return columns;
  }();
  return all;
}

std::vector<Value> parameter_values(const sweep::RunRow& row) {
  std::vector<Value> values;
  values.reserve(group_columns().size());
  for (const sweep::Column* column : group_columns()) values.push_back(column->get(row));
  return values;
}

Finding finding_of(const Group& group) { return scene_of(group.first_row.parameters).finding; }

bool has_clogging_length(const sweep::RunRow& row) {
  return scene_of(row.parameters).finding == Finding::clogging_length;
}

std::string outcome_of(const sweep::RunRow& row) {
  const bool is_on_wall = scene_of(row.parameters).finding == Finding::sag;
  return is_on_wall && row.status == RunStatus::clogged ? outcome_at_rest : name(row.status);
}

std::vector<Field> result_fields(const Group& group) {
  std::string doubts;
  for (const Doubt doubt : group.doubts)
    doubts += std::string(doubts.empty() ? "" : " ") + text_of(doubt).word;
  std::vector<Field> fields;
  if (!has_clogging_length(group.first_row)) {
    fields = {{"interrupted", value_of(group.num_interrupted)},
              {"failed", value_of(group.num_failed)},
              {"damaged", value_of(group.num_damaged)},
              {"doubts", doubts}};
    for (const char* name :
         {"status", "distance", "time", "largest_shape_parameter", "largest_shape_parameter_at",
          "largest_relative_speed", "largest_relative_speed_at", "smallest_relative_speed",
          "smallest_relative_speed_at", "sag", "top_sag", "thinnest_neck", "thinnest_neck_at",
          "shape_parameter", "mean_speed"})
      fields.emplace_back(name, sweep::column(name).get(group.first_row));
    return fields;
  }
  const RunParameters& run = group.first_row.parameters;
  const bool is_lattice = run.obstacles.layout == ObstacleLayout::lattice;
  const double line_tension = run.model == Model::dp ? run.dp.line_tension : sweep::RunRow::not_known;
  fields = {{"runs", value_of(group.clogging.num_runs)},
            {"clogs", value_of(group.clogging.num_clogs)},
            {"passed", value_of(group.num_passed)},
            {"flowing", value_of(group.num_flowing)},
            {"interrupted", value_of(group.num_interrupted)},
            {"failed", value_of(group.num_failed)},
            {"damaged", value_of(group.num_damaged)},
            {"failed_somewhere", value_of(group.num_failed_somewhere)},
            {"failures_per_length", value_of(failures_per_length(group))},
            {"left_out", value_of(group.num_left_out)},
            {"repeated", value_of(group.num_repeated)},
            {"dwell", is_dwell_possible(group) ? value_of(group.dwell) : Value()},
            {"dwells_known_from", value_of(group.dwells_known_from)},
            {"repeating", value_of(group.num_repeating)},
            {"on_mesh", value_of(group.num_on_mesh)},
            {"stability_unknown", value_of(group.num_stability_unknown)},
            {"near_friction_limit", value_of(group.num_near_friction_limit)},
            {"total_distance", value_of(group.clogging.total_distance)},
            {"clogging_length", value_of(group.clogging.length)},
            {"clogging_length_lower", value_of(group.clogging.interval.lower)},
            {"clogging_length_upper", value_of(group.clogging.interval.upper)},
            {"clogging_length_profile_lower", value_of(group.clogging.profile.lower)},
            {"clogging_length_profile_upper", value_of(group.clogging.profile.upper)},
            {"clogging_length_least_squares", value_of(group.least_squares_length)},
            {"met_none", value_of(group.num_free)},
            {"displaced", value_of(static_cast<int>(group.displaced.size()))},
            {"contacts_per_length", value_of(group.contacts_per_length)},
            {"clogging_length_met", value_of(group.clogging_met.length)},
            {"clogging_length_met_lower", value_of(group.clogging_met.interval.lower)},
            {"clogging_length_met_upper", value_of(group.clogging_met.interval.upper)},
            {"weibull_shape", finite_value(group.weibull.shape)},
            {"weibull_p_value", value_of(group.weibull.p_value)},
            {"relative_speed", value_of(group.relative_speed.mean)},
            {"relative_speed_error", value_of(group.relative_speed.standard_error)},
            {"relative_speed_runs", value_of(group.relative_speed.num_runs)},
            {"relative_speed_pooled", value_of(group.relative_speed_pooled.mean)},
            {"relative_speed_pooled_error", value_of(group.relative_speed_pooled.standard_error)},
            {"relative_speed_all", value_of(group.relative_speed_all.mean)},
            {"relative_speed_all_error", value_of(group.relative_speed_all.standard_error)},
            {"relative_speed_steady", value_of(group.relative_speed_steady.mean)},
            {"relative_speed_steady_error", value_of(group.relative_speed_steady.standard_error)},
            {"relative_speed_steady_runs", value_of(group.relative_speed_steady.num_runs)},
            {"capillary_number", value_of(group.relative_speed.mean * units::droplet_mass / line_tension)},
            {"lateral_slope", value_of(group.migration.slope)},
            {"lateral_slope_error", value_of(group.migration.standard_error)},
            {"row_angle", value_of(group.row_angle)},
            {"row_share", value_of(share_along_rows(group).slope)},
            {"row_share_error", value_of(share_along_rows(group).standard_error)},
            {"pitch", is_lattice ? value_of(run.obstacles.spacing()) : Value()},
            {"row_spacing", is_lattice ? value_of(row_spacing(run.obstacles)) : Value()},
            {"doubts", doubts}};
  append_causes(group, fields);
  return fields;
}

}  // namespace clog::results

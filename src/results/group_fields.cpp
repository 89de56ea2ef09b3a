#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/portable_math.hpp"
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

/// Appends the number of runs that each cause ended, and the lengths. All these fields are unset if the
/// causes are unknown.
void append_causes(const Group& group, std::vector<Field>& fields) {
  const bool are_known = !group.causes.empty();
  const auto add = [&](const std::string& name, auto number, const char* unit) {
    fields.push_back({name, are_known ? value_of(number) : Value(), unit});
  };
  for (std::size_t i = 0; i < std::size(cause_texts); ++i) {
    const fit::CloggingLength fit = are_known ? group.causes[i].ends : fit::CloggingLength();
    const std::string length = cause_texts[i].length;
    add(cause_texts[i].count, fit.num_clogs, "");
    add(length, fit.length, "sigma");
    add(length + "_lower", fit.interval.lower, "sigma");
    add(length + "_upper", fit.interval.upper, "sigma");
  }
}

}  // namespace

double terminal_speed_in_laboratory(const Group& group) {
  const LaboratoryScale scale = group.laboratory.value_or(LaboratoryScale());
  if (!std::isfinite(scale.speed)) return scale.speed;
  return group.first_row.parameters.drag.terminal_speed * scale.length / scale.time;
}

double failures_per_length(const Group& group) {
  const double way = group.clogging.total_distance;
  return way > 0 ? group.num_failed_counted / way : sweep::RunRow::not_known;
}

fit::Migration share_along_rows(const Group& group) {
  const double slope = portable::tan(group.row_angle * std::numbers::pi / 180);
  if (slope == 0) return {.slope = sweep::RunRow::not_known, .standard_error = sweep::RunRow::not_known};
  return {.slope = group.migration.slope / slope,
          .standard_error = group.migration.standard_error / std::abs(slope)};
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
  const std::string doubts = words_of(group.doubts);
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
      fields.push_back({name, sweep::column(name).get(group.first_row), sweep::column(name).unit});
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
            {"failures_per_length", value_of(failures_per_length(group)), "1/sigma"},
            {"left_out", value_of(group.num_left_out)},
            {"repeated", value_of(group.num_repeated)},
            {"dwell", is_dwell_possible(group) ? value_of(group.dwell) : Value(), "t0"},
            {"dwells_known_from", value_of(group.dwells_known_from), "t0"},
            {"repeating", value_of(group.num_repeating)},
            {"on_mesh", value_of(group.num_on_mesh)},
            {"stability_unknown", value_of(group.num_stability_unknown)},
            {"near_friction_limit", value_of(group.num_near_friction_limit)},
            {"total_distance", value_of(group.clogging.total_distance), "sigma"},
            {"clogging_length", value_of(group.clogging.length), "sigma"},
            {"clogging_length_lower", value_of(group.clogging.interval.lower), "sigma"},
            {"clogging_length_upper", value_of(group.clogging.interval.upper), "sigma"},
            {"clogging_length_profile_lower", value_of(group.clogging.profile.lower), "sigma"},
            {"clogging_length_profile_upper", value_of(group.clogging.profile.upper), "sigma"},
            {"clogging_length_least_squares", value_of(group.least_squares_length), "sigma"},
            {"met_none", value_of(group.num_free)},
            {"displaced", value_of(static_cast<int>(group.displaced.size()))},
            {"contacts_per_length", value_of(group.contacts_per_length), "1/sigma"},
            {"clogging_length_met", value_of(group.clogging_met.length), "sigma"},
            {"clogging_length_met_lower", value_of(group.clogging_met.interval.lower), "sigma"},
            {"clogging_length_met_upper", value_of(group.clogging_met.interval.upper), "sigma"},
            {"weibull_shape", finite_value(group.weibull.shape)},
            {"weibull_p_value", value_of(group.weibull.p_value)},
            {"relative_speed", value_of(group.relative_speed.mean), "v_t"},
            {"relative_speed_error", value_of(group.relative_speed.standard_error), "v_t"},
            {"relative_speed_runs", value_of(group.relative_speed.num_runs)},
            {"relative_speed_pooled", value_of(group.relative_speed_pooled.mean), "v_t"},
            {"relative_speed_pooled_error", value_of(group.relative_speed_pooled.standard_error), "v_t"},
            {"relative_speed_all", value_of(group.relative_speed_all.mean), "v_t"},
            {"relative_speed_all_error", value_of(group.relative_speed_all.standard_error), "v_t"},
            {"relative_speed_steady", value_of(group.relative_speed_steady.mean), "v_t"},
            {"relative_speed_steady_error", value_of(group.relative_speed_steady.standard_error), "v_t"},
            {"relative_speed_steady_runs", value_of(group.relative_speed_steady.num_runs)},
            {"capillary_number", value_of(group.relative_speed.mean * units::droplet_mass / line_tension)},
            {"lateral_slope", value_of(group.migration.slope)},
            {"lateral_slope_error", value_of(group.migration.standard_error)},
            {"row_angle", value_of(group.row_angle), "degrees"},
            {"row_share", value_of(share_along_rows(group).slope)},
            {"row_share_error", value_of(share_along_rows(group).standard_error)},
            {"pitch", is_lattice ? value_of(run.obstacles.spacing()) : Value(), "sigma"},
            {"row_spacing", is_lattice ? value_of(row_spacing(run.obstacles)) : Value(), "sigma"},
            {"doubts", doubts}};
  append_causes(group, fields);
  return fields;
}

}  // namespace clog::results

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "clog/console/rounded.hpp"
#include "clog/core/tools/number_text.hpp"
#include "result_columns.hpp"
#include "value_json.hpp"

namespace clog::results {
namespace {

LaboratoryScale scale_of(const Group& group) { return group.laboratory.value_or(LaboratoryScale()); }

/// The mean speed of all runs [mm/s].
fit::MeanSpeed speed_in_mm_per_s(const Group& group) {
  const double terminal_speed = terminal_speed_in_laboratory(group);
  fit::MeanSpeed speed = group.relative_speed_all;
  speed.mean *= terminal_speed;
  speed.standard_error *= terminal_speed;
  return speed;
}

/// Mean time until a clog [s]: lambda in mm divided by the speed of all runs in mm/s.
double time_to_clog(const Group& group) {
  if (group.clogging.num_clogs == 0) return std::numeric_limits<double>::quiet_NaN();
  return group.clogging.length * scale_of(group).length / speed_in_mm_per_s(group).mean;
}

/// The interfacial tension of a polygon [mN/m]; NaN for the soft disk. Runs of the laboratory's droplet have
/// the tension of this droplet. This tension differs a little from the tension that follows from the Gamma of
/// the runs, which is rounded.
double tension_of(const Group& group) {
  const RunParameters& run = group.first_row.parameters;
  const LaboratoryScale scale = scale_of(group);
  if (run.model != Model::dp) return std::numeric_limits<double>::quiet_NaN();
  return run.dp.line_tension == scale.line_tension ? scale.own_tension : run.dp.line_tension * scale.tension;
}

/// The group's clogging length in millimetres; NaN without a laboratory.
fit::CloggingLength clogging_in_mm(const Group& group) {
  fit::CloggingLength clogging = group.clogging;
  for (double* length : {&clogging.length, &clogging.interval.lower, &clogging.interval.upper})
    *length *= scale_of(group).length;
  return clogging;
}

bool is_constant(const ResultColumn& column, const std::vector<Group>& groups) {
  return std::ranges::all_of(
      groups, [&](const Group& group) { return column.cell(group) == column.cell(groups.front()); });
}

}  // namespace

bool have_laboratory(const std::vector<Group>& groups) {
  return std::ranges::any_of(groups, [](const Group& group) {
    return group.laboratory.has_value() && has_clogging_length(group.first_row);
  });
}

std::vector<Field> laboratory_fields(const Group& group) {
  const LaboratoryScale scale = scale_of(group);
  const fit::CloggingLength clogging = clogging_in_mm(group);
  return {{"diameter_mm", finite_value(twelve_digits(scale.length)), "mm"},
          {"angle_degrees", finite_value(scale.tilt)},
          {"tension_mN_per_m", finite_value(tension_of(group)), "mN/m"},
          {"clogging_length_mm", finite_value(clogging.length), "mm"},
          {"clogging_length_lower_mm", finite_value(clogging.interval.lower), "mm"},
          {"clogging_length_upper_mm", finite_value(clogging.interval.upper), "mm"},
          {"speed_mm_per_s", finite_value(speed_in_mm_per_s(group).mean), "mm/s"},
          {"speed_error_mm_per_s", finite_value(speed_in_mm_per_s(group).standard_error), "mm/s"},
          {"time_to_clog_s", finite_value(time_to_clog(group)), "s"}};
}

std::vector<ResultColumn> droplet_columns(const std::vector<Group>& groups) {
  if (!have_laboratory(groups)) return {};
  const auto column_of = [&](const char* name, double LaboratoryScale::*number) {
    const auto value_of = [number](const Group& group) {
      return finite_value(twelve_digits(scale_of(group).*number));
    };
    const int digits = digits_in(groups, value_of);
    return ResultColumn{name, [=](const Group& group) { return short_text(value_of(group), digits); }};
  };
  std::vector<ResultColumn> columns = {column_of("diameter/mm", &LaboratoryScale::length),
                                       column_of("angle/degrees", &LaboratoryScale::tilt)};
  std::erase_if(columns, [&](const ResultColumn& column) { return is_constant(column, groups); });
  return columns;
}

std::vector<ResultColumn> laboratory_columns(const std::vector<Group>& groups, double confidence) {
  const bool have_several_droplets = !droplet_columns(groups).empty();
  std::vector<ResultColumn> columns = {
      {is_device(groups.front().first_row.parameters) ? "lambda_met/mm" : "lambda/mm",
       [](const Group& group) { return length_text(clogging_in_mm(group)); }},
      {fmt::format("{:g} %", 100 * confidence),
       [](const Group& group) { return interval_text(clogging_in_mm(group)); }}};
  columns.insert(columns.end(), {{"all runs/(mm/s)",
                                  [](const Group& group) {
                                    const fit::MeanSpeed speed = speed_in_mm_per_s(group);
                                    return console::with_error(speed.mean, speed.standard_error).value;
                                  }},
                                 {"time to clog/s",
                                  [](const Group& group) { return console::plain(time_to_clog(group)); }}});
  const ResultColumn tension = {"tension/(mN/m)",
                                [](const Group& group) { return console::plain(tension_of(group)); }};
  const bool has_polygons = std::ranges::any_of(
      groups, [](const Group& group) { return group.first_row.parameters.model == Model::dp; });
  if (has_polygons && !(have_several_droplets && is_constant(tension, groups)))
    columns.insert(have_several_droplets ? columns.end() : columns.begin(), tension);
  return columns;
}

}  // namespace clog::results

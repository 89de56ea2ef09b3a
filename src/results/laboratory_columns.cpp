#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "clog/console/rounded.hpp"
#include "result_columns.hpp"
#include "value_json.hpp"

namespace clog::results {
namespace {

LaboratoryScale scale_of(const Group& group) { return group.laboratory.value_or(LaboratoryScale()); }

/// Mean time until a clog: lambda divided by the speed of all runs, in units of the laboratory's terminal
/// speed [s].
double time_to_clog(const Group& group) {
  const LaboratoryScale scale = scale_of(group);
  if (group.clogging.num_clogs == 0) return std::numeric_limits<double>::quiet_NaN();
  return group.clogging.length * scale.length / (group.relative_speed_all.mean * scale.speed);
}

/// The interfacial tension of a polygon [mN/m]; NaN for the soft disk.
double tension_of(const Group& group) {
  const RunParameters& run = group.first_row.parameters;
  return run.model == Model::dp ? run.dp.line_tension * scale_of(group).tension
                                : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

double short_number(double value) {
  return std::isfinite(value) ? std::stod(fmt::format("{:.12g}", value)) : value;
}

bool have_laboratory(const std::vector<Group>& groups) {
  return has_clogging_length(groups.front().first_row) &&
         std::ranges::any_of(groups, [](const Group& group) { return group.laboratory.has_value(); });
}

std::vector<Field> laboratory_fields(const Group& group) {
  const LaboratoryScale scale = scale_of(group);
  const fit::CloggingLength& clogging = group.clogging;
  return {{"diameter_mm", finite_value(short_number(scale.length))},
          {"angle_degrees", finite_value(scale.tilt)},
          {"tension_mN_per_m", finite_value(tension_of(group))},
          {"clogging_length_mm", finite_value(clogging.length * scale.length)},
          {"clogging_length_lower_mm", finite_value(clogging.interval.lower * scale.length)},
          {"clogging_length_upper_mm", finite_value(clogging.interval.upper * scale.length)},
          {"speed_mm_per_s", finite_value(group.relative_speed_all.mean * scale.speed)},
          {"speed_error_mm_per_s", finite_value(group.relative_speed_all.standard_error * scale.speed)},
          {"time_to_clog_s", finite_value(time_to_clog(group))}};
}

std::vector<ResultColumn> laboratory_columns(const std::vector<Group>& groups) {
  std::vector<ResultColumn> columns = {
      {"lambda/mm",
       [](const Group& group) {
         const LaboratoryScale scale = scale_of(group);
         const fit::CloggingLength& clogging = group.clogging;
         if (clogging.num_runs == 0 || std::isnan(scale.length)) return std::string("-");
         if (clogging.num_clogs == 0) return "> " + console::plain(clogging.interval.lower * scale.length);
         return console::with_interval(clogging.length * scale.length, clogging.interval.lower * scale.length,
                                       clogging.interval.upper * scale.length)
             .value;
       }},
      {"all runs/(mm/s)",
       [](const Group& group) {
         const LaboratoryScale scale = scale_of(group);
         return console::with_error(group.relative_speed_all.mean * scale.speed,
                                    group.relative_speed_all.standard_error * scale.speed)
             .value;
       }},
      {"time to clog/s", [](const Group& group) { return console::plain(time_to_clog(group)); }}};
  if (std::ranges::any_of(groups,
                          [](const Group& group) { return group.first_row.parameters.model == Model::dp; }))
    columns.insert(columns.begin(),
                   {"tension/(mN/m)", [](const Group& group) { return console::plain(tension_of(group)); }});
  return columns;
}

}  // namespace clog::results

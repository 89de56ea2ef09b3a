#include "result_columns.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "clog/console/rounded.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/joined.hpp"

namespace clog::results {
namespace {

/// The group's break-ups; nullptr unless all mechanisms are known: files with break-ups have mechanisms, too.
const fit::CloggingLength* break_ups(const Group& group) {
  for (const Group::EndsBy& cause : group.causes)
    if (cause.text->cause == Cause::broken) return &cause.ends;
  return nullptr;
}

}  // namespace

bool are_mechanisms_shown(const std::vector<Group>& groups) {
  std::set<Cause> seen;
  for (const Group& group : groups)
    for (const Group::EndsBy& cause : group.causes)
      if (cause.text->is_clog && cause.ends.num_clogs > 0) seen.insert(cause.text->cause);
  return seen.size() > 1 ||
         std::any_of(groups.begin(), groups.end(), [](const Group& group) { return group.num_left_out > 0; });
}

bool have_some_broken(const std::vector<Group>& groups) {
  return std::ranges::any_of(groups, [](const Group& group) {
    const fit::CloggingLength* broken = break_ups(group);
    return broken && broken->num_clogs > 0;
  });
}

namespace {

bool is_lattice(const Group& group) {
  return group.first_row.parameters.obstacles.layout == ObstacleLayout::lattice;
}

/// Clogs by mechanism, as 3/5/2/0.
std::string mechanism_counts(const Group& group) {
  std::vector<std::string> counts;
  for (const Group::EndsBy& cause : group.causes)
    if (cause.text->is_clog) counts.push_back(std::to_string(cause.ends.num_clogs));
  return counts.empty() ? "-" : joined(counts, "/");
}

std::string break_up_length(const Group& group) {
  const fit::CloggingLength* broken = break_ups(group);
  if (!broken || broken->num_runs == 0) return "-";
  if (broken->num_clogs == 0) return "> " + console::plain(broken->interval.lower);
  return console::with_interval(broken->length, broken->interval.lower, broken->interval.upper).value;
}

console::RoundedInterval length_of(const fit::CloggingLength& clogging) {
  return console::with_interval(clogging.length, clogging.interval.lower, clogging.interval.upper);
}
bool has_length(const fit::CloggingLength& clogging) { return clogging.num_clogs > 0; }

std::string length_text(const fit::CloggingLength& clogging) {
  if (has_length(clogging)) return length_of(clogging).value;
  return clogging.num_runs == 0 ? "-" : "> " + console::plain(clogging.interval.lower);
}
std::string interval_text(const fit::CloggingLength& clogging) {
  const console::RoundedInterval length = length_of(clogging);
  return has_length(clogging) ? length.lower + " .. " + length.upper : "-";
}

/// Columns of lambda for the droplets that met an obstacle, in groups in which some met none.
std::vector<ResultColumn> columns_of_met(const std::string& confidence) {
  return {{"met none", [](const Group& group) { return std::to_string(group.num_free); }},
          {"lambda_met", [](const Group& group) { return length_text(group.clogging_met); }},
          {confidence, [](const Group& group) { return interval_text(group.clogging_met); }}};
}

console::RoundedError speed_of(const Group& group) {
  return console::with_error(group.relative_speed.mean, group.relative_speed.standard_error);
}
console::RoundedError speed_of_all(const Group& group) {
  return console::with_error(group.relative_speed_all.mean, group.relative_speed_all.standard_error);
}

/// Columns for groups in which some runs are too short to have a speed: the number of the others, whose mean
/// is shown, and the speed of all runs.
std::vector<ResultColumn> columns_of_all_speeds() {
  return {{"of", [](const Group& group) { return std::to_string(group.relative_speed.num_runs); }},
          {"all runs", [](const Group& group) { return speed_of_all(group).value; }},
          {"+-", [](const Group& group) { return speed_of_all(group).error; }}};
}
bool lacks_speeds(const Group& group) {
  return !std::isnan(group.relative_speed.mean) && group.relative_speed.num_runs < group.clogging.num_runs;
}

console::RoundedError slope_of(const Group& group) {
  return console::with_error(group.migration.slope, group.migration.standard_error);
}

std::vector<ResultColumn> columns_of_arrays(const std::vector<Group>& groups, double confidence,
                                            bool has_laboratory) {
  const bool is_of_device =
      std::ranges::all_of(groups, [](const Group& group) { return is_device(group.first_row.parameters); });
  std::vector<ResultColumn> columns = {
      {"runs", [](const Group& group) { return std::to_string(group.clogging.num_runs); }},
      {"clogs", [](const Group& group) { return std::to_string(group.clogging.num_clogs); }}};
  if (std::ranges::any_of(groups, [](const Group& group) { return group.num_passed > 0; }))
    columns.insert(columns.end(),
                   {{"passed", [](const Group& group) { return std::to_string(group.num_passed); }},
                    {"flowing", [](const Group& group) { return std::to_string(group.num_flowing); }}});
  if (are_mechanisms_shown(groups)) columns.push_back({"w/s/h/o", mechanism_counts});
  const std::string level = fmt::format("{:g} %", 100 * confidence);
  columns.insert(columns.end(), {{is_of_device ? "lambda_met/sigma" : "lambda/sigma",
                                  [](const Group& group) { return length_text(group.clogging); }},
                                 {level, [](const Group& group) { return interval_text(group.clogging); }}});
  if (is_of_device)
    columns.push_back({"met none", [](const Group& group) { return std::to_string(group.num_free); }});
  else if (std::ranges::any_of(groups, [](const Group& group) { return group.num_free > 0; }))
    for (ResultColumn& column : columns_of_met(level)) columns.push_back(std::move(column));
  if (have_some_broken(groups))
    columns.insert(columns.end(), {{"broken",
                                    [](const Group& group) {
                                      const fit::CloggingLength* broken = break_ups(group);
                                      return broken ? std::to_string(broken->num_clogs) : "-";
                                    }},
                                   {"lambda_b/sigma", break_up_length}});
  columns.insert(columns.end(), {{"<v_g>/v_t", [](const Group& group) { return speed_of(group).value; }},
                                 {"+-", [](const Group& group) { return speed_of(group).error; }}});
  // Speeds in laboratory units are those of all runs.
  if (has_laboratory || std::ranges::any_of(groups, lacks_speeds))
    for (ResultColumn& column : columns_of_all_speeds()) columns.push_back(std::move(column));
  // A droplet in a random array goes straight on average.
  if (std::any_of(groups.begin(), groups.end(), is_lattice))
    columns.insert(columns.end(), {{"lateral/r", [](const Group& group) { return slope_of(group).value; }},
                                   {"+-", [](const Group& group) { return slope_of(group).error; }}});
  return columns;
}

/// A number of the one run that a group has where nothing is random.
ResultColumn column_of_run(const char* name, double sweep::RunRow::*value) {
  return {name, [=](const Group& group) { return console::plain(group.first_row.*value, 4); }};
}
ResultColumn outcome_column() {
  return {"outcome", [](const Group& group) { return std::string(name(group.first_row.status)); }};
}

std::vector<ResultColumn> columns_of_channels() {
  using sweep::RunRow;
  return {outcome_column(),
          column_of_run("largest A", &RunRow::largest_shape_parameter),
          column_of_run("at h", &RunRow::largest_shape_parameter_at),
          column_of_run("least v/v_t", &RunRow::smallest_relative_speed),
          column_of_run("at h", &RunRow::smallest_relative_speed_at),
          column_of_run("most v/v_t", &RunRow::largest_relative_speed),
          column_of_run("at h", &RunRow::largest_relative_speed_at)};
}

std::vector<ResultColumn> columns_of_walls() {
  using sweep::RunRow;
  return {{"outcome",
           [](const Group& group) {
             const RunStatus status = group.first_row.status;
             return std::string(status == RunStatus::clogged ? "at rest" : name(status));
           }},
          column_of_run("sag", &RunRow::sag),
          column_of_run("top sag", &RunRow::top_sag),
          column_of_run("A", &RunRow::shape_parameter)};
}

}  // namespace

std::vector<ResultColumn> columns_of_findings(const std::vector<Group>& groups, double confidence,
                                              bool has_laboratory) {
  switch (scene_of(groups.front().first_row.parameters).finding) {
    case Finding::clogging_length:
      return columns_of_arrays(groups, confidence, has_laboratory);
    case Finding::passage:
      return columns_of_channels();
    case Finding::sag:
      return columns_of_walls();
  }
  throw std::logic_error("a finding without columns");
}

}  // namespace clog::results

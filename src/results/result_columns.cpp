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

/// The length of the group's break-ups; nullptr if its mechanisms are unknown. (All files with break-ups also
/// have mechanisms.)
const fit::CloggingLength* break_ups(const Group& group) {
  for (const Group::EndsBy& cause : group.causes)
    if (cause.text->cause == Cause::broken) return &cause.ends;
  return nullptr;
}

console::RoundedInterval length_of(const fit::CloggingLength& clogging) {
  return console::with_interval(clogging.length, clogging.interval.lower, clogging.interval.upper);
}

bool has_rows(const Group& group) { return !std::isnan(group.row_angle); }

}  // namespace

std::string length_text(const fit::CloggingLength& clogging) {
  if (clogging.num_clogs > 0) return length_of(clogging).value;
  return clogging.num_runs == 0 || std::isnan(clogging.interval.lower)
             ? "-"
             : "> " + console::plain(clogging.interval.lower);
}
std::string interval_text(const fit::CloggingLength& clogging) {
  const console::RoundedInterval length = length_of(clogging);
  return std::isfinite(clogging.length) ? length.lower + " .. " + length.upper : "-";
}

std::vector<const CauseText*> mechanisms_of_clogs(const std::vector<Group>& groups) {
  std::set<const CauseText*> seen;
  for (const Group& group : groups)
    for (const Group::EndsBy& cause : group.causes)
      if (cause.text->is_clog && cause.ends.num_clogs > 0) seen.insert(cause.text);
  return {seen.begin(), seen.end()};
}

bool are_mechanisms_shown(const std::vector<Group>& groups) {
  const std::size_t number = mechanisms_of_clogs(groups).size();
  return number > 1 || (number > 0 && std::ranges::any_of(
                                          groups, [](const Group& group) { return group.num_left_out > 0; }));
}

bool have_some_broken(const std::vector<Group>& groups) {
  return std::ranges::any_of(groups, [](const Group& group) {
    const fit::CloggingLength* broken = break_ups(group);
    return broken && broken->num_clogs > 0;
  });
}

namespace {

/// Numbers of clogs by mechanism, such as 3/5/2/0.
std::string mechanism_counts(const Group& group) {
  std::vector<std::string> counts;
  for (const Group::EndsBy& cause : group.causes)
    if (cause.text->is_clog) counts.push_back(std::to_string(cause.ends.num_clogs));
  return counts.empty() ? "-" : joined(counts, "/");
}

std::string break_up_length(const Group& group) {
  const fit::CloggingLength* broken = break_ups(group);
  return broken ? length_text(*broken) : "-";
}

ResultColumn column_of(const char* name, int Group::*number) {
  return {name, [=](const Group& group) { return std::to_string(group.*number); }};
}
ResultColumn column_of(const char* name, int fit::CloggingLength::*number) {
  return {name, [=](const Group& group) { return std::to_string(group.clogging.*number); }};
}

/// Appends a length and its interval.
void append(const char* name, fit::CloggingLength Group::*length, double confidence,
            std::vector<ResultColumn>& columns) {
  columns.push_back({name, [=](const Group& group) { return length_text(group.*length); }});
  columns.push_back({fmt::format("{:g} %", 100 * confidence),
                     [=](const Group& group) { return interval_text(group.*length); }});
}

/// Appends a number and its error.
void append(const char* name, console::RoundedError (*number)(const Group&),
            std::vector<ResultColumn>& columns) {
  columns.push_back({name, [=](const Group& group) { return number(group).value; }});
  columns.push_back({"+-", [=](const Group& group) { return number(group).error; }});
}

console::RoundedError speed_of(const Group& group) {
  return console::with_error(group.relative_speed_steady.mean, group.relative_speed_steady.standard_error);
}
console::RoundedError speed_of_all(const Group& group) {
  return console::with_error(group.relative_speed_all.mean, group.relative_speed_all.standard_error);
}
console::RoundedError slope_of(const Group& group) {
  return console::with_error(group.migration.slope, group.migration.standard_error);
}
console::RoundedError share_of(const Group& group) {
  const fit::Migration share = share_along_rows(group);
  return console::with_error(share.slope, share.standard_error);
}

/// Whether some runs ended before the steady speed begins.
bool lacks_speeds(const Group& group) {
  return group.relative_speed_steady.num_runs < group.clogging.num_runs;
}

std::vector<ResultColumn> columns_of_arrays(const std::vector<Group>& groups, double confidence,
                                            bool has_laboratory) {
  const auto have_any = [&](int Group::*number) {
    return std::ranges::any_of(groups, [=](const Group& group) { return group.*number > 0; });
  };
  const bool is_of_device =
      std::ranges::all_of(groups, [](const Group& group) { return is_device(group.first_row.parameters); });
  std::vector<ResultColumn> columns = {column_of("runs", &fit::CloggingLength::num_runs),
                                       column_of("clogs", &fit::CloggingLength::num_clogs)};
  if (have_any(&Group::num_passed))
    columns.insert(columns.end(),
                   {column_of("passed", &Group::num_passed), column_of("flowing", &Group::num_flowing)});
  if (have_any(&Group::num_failed))
    columns.insert(columns.end(), {column_of("failed", &Group::num_failed),
                                   {"per 1000 sigma", [](const Group& group) {
                                      return console::plain(1000 * failures_per_length(group));
                                    }}});
  if (are_mechanisms_shown(groups)) columns.push_back({"w/s/h/o", mechanism_counts});
  append(is_of_device ? "lambda_met/sigma" : "lambda/sigma", &Group::clogging, confidence, columns);
  if (is_of_device || have_any(&Group::num_free)) columns.push_back(column_of("met none", &Group::num_free));
  if (!is_of_device && have_any(&Group::num_free))
    append("lambda_met", &Group::clogging_met, confidence, columns);
  if (have_some_broken(groups))
    columns.insert(columns.end(), {{"broken",
                                    [](const Group& group) {
                                      const fit::CloggingLength* broken = break_ups(group);
                                      return broken ? std::to_string(broken->num_clogs) : "-";
                                    }},
                                   {"lambda_b/sigma", break_up_length}});
  append("<v_g>/v_t", speed_of, columns);
  const bool have_few_speeds = std::ranges::any_of(groups, lacks_speeds);
  if (have_few_speeds)
    columns.push_back(
        {"of", [](const Group& group) { return std::to_string(group.relative_speed_steady.num_runs); }});
  // Speeds in laboratory units are speeds of all runs, so this column belongs to them.
  if (has_laboratory || have_few_speeds) append("all runs", speed_of_all, columns);
  // Only groups with rows of posts get these columns. In a random array, droplets do not drift sideways on
  // average.
  if (std::ranges::any_of(groups, has_rows)) {
    append("lateral/r", slope_of, columns);
    append("along rows", share_of, columns);
  }
  return columns;
}

/// A column with a number from the single run of a group without randomness.
template <class Place>
ResultColumn column_of_run(const char* name, Place number) {
  return {name, [=](const Group& group) { return console::plain(number(group.first_row), 4); }};
}

std::vector<ResultColumn> columns_of_channels() {
  using Row = const sweep::RunRow&;
  return {{"outcome", [](const Group& group) { return outcome_of(group.first_row); }},
          column_of_run("largest A", [](Row row) { return row.passage.largest_shape_parameter.value; }),
          column_of_run("at h", [](Row row) { return row.passage.largest_shape_parameter.place; }),
          column_of_run("least v/v_t", [](Row row) { return row.passage.smallest_speed.value; }),
          column_of_run("at h", [](Row row) { return row.passage.smallest_speed.place; }),
          column_of_run("most v/v_t", [](Row row) { return row.passage.largest_speed.value; }),
          column_of_run("at h", [](Row row) { return row.passage.largest_speed.place; })};
}

std::vector<ResultColumn> columns_of_walls() {
  using Row = const sweep::RunRow&;
  return {{"outcome", [](const Group& group) { return outcome_of(group.first_row); }},
          column_of_run("sag", [](Row row) { return row.sag.centre; }),
          column_of_run("top sag", [](Row row) { return row.sag.top; }),
          column_of_run("A", [](Row row) { return row.shape_parameter; })};
}

}  // namespace

std::vector<ResultColumn> columns_of_findings(const std::vector<Group>& groups, double confidence,
                                              bool has_laboratory) {
  switch (finding_of(groups.front())) {
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

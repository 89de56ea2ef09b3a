#include "clog/results/groups.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/core/tools/split.hpp"
#include "clog/core/tools/units.hpp"
#include "clog/sweep/obstacle_arrays.hpp"
#include "clog/sweep/row_check.hpp"
#include "clog/sweep/row_limits.hpp"
#include "clog/sweep/value_list.hpp"
#include "passages.hpp"

namespace clog::results {
namespace {

Value value_of(double number) { return std::isnan(number) ? Value() : Value(number); }
Value value_of(int count) { return std::int64_t{count}; }

bool is_ensemble(const sweep::Column& column) {
  return column.parameter && column.parameter->role == ParameterRole::ensemble;
}

bool is_numerics(const sweep::Column& column) {
  return column.parameter && column.parameter->role == ParameterRole::numerics;
}

/// May so many of the clogs be the mesh's that they move the length?
bool hangs_on_mesh(const Group& group) {
  constexpr double tolerated = 0.1;  // of the clogs
  return group.num_on_mesh > 0 && group.num_on_mesh >= tolerated * group.clogging.num_clogs;
}

std::vector<Doubt> doubts_about(const Group& group) {
  std::vector<Doubt> doubts;
  if (!has_clogging_length(group.first_row)) {
    if (group.num_interrupted > 0 || group.num_failed > 0) doubts.push_back(Doubt::incomplete);
    if (group.num_damaged > 0) doubts.push_back(Doubt::damaged);
    if (!sweep::unproven_parameters(group.first_row).empty()) doubts.push_back(Doubt::not_proved_sound);
    return doubts;
  }
  const bool has_runs = group.clogging.num_runs > 0;  // not if all ended before distances are counted
  // Where all droplets passed the exit, more seeds add nothing but a higher bound.
  const bool have_all_passed = group.num_passed == group.clogging.num_runs;
  if (has_runs && !have_all_passed && group.clogging.num_clogs < enough_clogs)
    doubts.push_back(Doubt::few_clogs);
  if (group.num_flowing > 0) doubts.push_back(Doubt::censored_by_time);
  if (group.num_interrupted > 0 || group.num_failed > 0) doubts.push_back(Doubt::incomplete);
  if (group.num_damaged > 0) doubts.push_back(Doubt::damaged);
  if (hangs_on_mesh(group)) doubts.push_back(Doubt::held_by_mesh);
  if (group.num_repeating > 0) doubts.push_back(Doubt::array_repeats);
  if (group.num_free > 0 && !is_device(group.first_row.parameters)) doubts.push_back(Doubt::met_none);
  if (group.clogging.length < sweep::obstacle_spacing(group.first_row))
    doubts.push_back(Doubt::below_spacing);
  if (!sweep::unproven_parameters(group.first_row).empty()) doubts.push_back(Doubt::not_proved_sound);
  return doubts;
}

void doubt_exponentiality(std::vector<Group>& groups) {
  std::vector<fit::WeibullTest> tests;
  for (const Group& group : groups) tests.push_back(group.weibull);
  const std::vector<bool> are_not = fit::are_not_exponential(tests);
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (are_not[i]) groups[i].doubts.push_back(Doubt::not_exponential);
}

/// The results of a run in a channel or on a wall.
std::vector<Field> fields_of_run(const sweep::RunRow& row) {
  std::vector<Field> fields;
  for (const char* name :
       {"status", "distance", "time", "largest_shape_parameter", "largest_shape_parameter_at",
        "largest_relative_speed", "largest_relative_speed_at", "smallest_relative_speed",
        "smallest_relative_speed_at", "sag", "top_sag", "thinnest_neck", "thinnest_neck_at",
        "shape_parameter", "mean_speed"})
    fields.emplace_back(name, sweep::column(name).get(row));
  return fields;
}

std::vector<double> censored_distances(std::span<const fit::Observation> runs) {
  std::vector<double> distances;
  for (const fit::Observation& run : runs)
    if (!run.clogged) distances.push_back(run.distance);
  std::sort(distances.begin(), distances.end());
  return distances;
}

/// How far a run got, and what it says about clogging.
struct Ending {
  double distance;  ///< [sigma]
  bool is_clog;
  std::optional<Cause> cause;  ///< of a clog, if it is known; of a break-up
};

std::optional<Cause> cause_of(const sweep::RunRow& run) {
  if (run.status == RunStatus::broken) return Cause::broken;
  if (run.status != RunStatus::clogged || !run.mechanism) return std::nullopt;
  switch (*run.mechanism) {
    case ClogMechanism::wrapped:
      return Cause::wrapped;
    case ClogMechanism::squeezed:
      return Cause::squeezed;
    case ClogMechanism::hybrid:
      return Cause::hybrid;
    case ClogMechanism::none:
      return Cause::other;
  }
  throw std::logic_error("a mechanism that is no cause");
}

/// May the run have dwells as long as this? One that has not begun has none.
bool has_dwells_to_tell(const sweep::RunRow& run, double dwell) {
  return dwell < run.parameters.max_time && run.steps > 0;
}

/// @param dwell  see group_runs()
Ending ending_of(const sweep::RunRow& run, double dwell) {
  const bool is_clogged = run.status == RunStatus::clogged;
  const Ending last = {run.distance, is_clogged, cause_of(run)};
  if (!has_dwells_to_tell(run, dwell)) return last;
  // The mechanism of a droplet that moved on is not known: it counts among the others.
  if (const Dwell* first = run.dwells.first_longer(dwell)) return {first->distance, true, Cause::other};
  return is_clogged || last.cause ? last : Ending{run.dwells.last_distance, false, {}};
}

/// The distance from the first obstacle on; below 0 if the droplet met none.
double distance_from_contact(const sweep::RunRow& run, double distance) {
  if (run.contacts == 0) return -1;
  return run.contacts < 0 ? distance : distance - run.first_contact_at;
}

Arrival arrival_of(const sweep::RunRow& run, const Ending& ending) {
  return {run.release_x + ending.distance, ending.is_clog || ending.cause.has_value()};
}

/// The later of two times; not known if one of them is not.
double later(double one, double other) { return std::isnan(one) || one > other ? one : other; }

/// Three figures, not less than the number, for people to type.
std::string rounded_up(double number) {
  const double unit = std::pow(10, std::floor(std::log10(number)) - 2);
  return fmt::format("{:.3g}", std::ceil(number / unit) * unit);
}

/// @throws Error if rows that are sound do not tell which droplets stood for so long
void require_dwells(std::span<const sweep::RunRow> rows, double dwell) {
  int num_unknown = 0;
  double known_from = 0;
  for (const sweep::RunRow& row : rows) {
    if (!has_dwells_to_tell(row, dwell) || dwell >= row.dwells.known_from) continue;
    if (row.status == RunStatus::failed || !sweep::fault_of(row).empty()) continue;  // left out
    num_unknown += std::isnan(row.dwells.known_from);
    if (row.dwells.known_from > known_from) known_from = row.dwells.known_from;
  }
  if (num_unknown > 0)
    throw Error(fmt::format(
        "cannot fit --dwell={} ({} of a version that did not look for dwells); compute the sweep anew, into "
        "another file",
        shortest(dwell), sweep::counted(num_unknown, "row")));
  if (known_from > 0)
    throw Error(
        fmt::format("cannot fit --dwell={} (the rows do not hold all dwells as short as that; column "
                    "dwells_known_from) use {} or more",
                    shortest(dwell), rounded_up(known_from)));
}

/// Clogging lengths of runs that are sound and reached the distance from which they count.
void fit_clogging(Group& group, std::span<const Ending> runs, double confidence, double from_distance) {
  // Observations in which only some of the ends are such, the other runs being censored where they ended.
  const auto observe = [&](auto is_end) {
    std::vector<fit::Observation> observations;
    observations.reserve(runs.size());
    for (const Ending& run : runs) observations.push_back({run.distance - from_distance, is_end(run)});
    return observations;
  };
  const std::vector<fit::Observation> all = observe([](const Ending& run) { return run.is_clog; });
  group.clogging = fit::fit_clogging_length(all, confidence);
  group.least_squares_length = fit::least_squares_length(all);
  group.weibull = fit::test_exponentiality(all);
  if (has_clogging_length(group.first_row)) {
    group.survival = fit::survival_curve(all, confidence);
    group.censored_distances = censored_distances(all);
  }
  if (std::any_of(runs.begin(), runs.end(), [](const Ending& run) { return run.is_clog && !run.cause; }))
    return;
  std::vector<fit::CompetingEnd> competing;
  for (const Ending& run : runs)
    competing.push_back({run.distance - from_distance,
                         run.cause ? std::optional(static_cast<int>(*run.cause)) : std::nullopt});
  for (const CauseText& text : cause_texts) {
    const auto is_of_cause = [&](const Ending& run) { return run.cause == text.cause; };
    Group::EndsBy& one = group.causes.emplace_back(
        Group::EndsBy{&text, fit::fit_clogging_length(observe(is_of_cause), confidence), {}});
    if (has_clogging_length(group.first_row))
      one.incidence = fit::cumulative_incidence(competing, static_cast<int>(text.cause), confidence);
  }
}

/// Fits the runs from the obstacles that they met on. @param runs  sound, and counted
struct Meetings {
  std::vector<fit::Observation> from_first;  ///< of the runs that met one
  std::int64_t num_contacts = 0;
  double way = 0;  ///< of all runs that tell [sigma]
  int num_free = 0;

  void count(const sweep::RunRow& run, const Ending& ending, double from_distance) {
    if (run.contacts < 0) return;
    num_contacts += run.contacts;
    way += std::max(0.0, run.distance);
    num_free += run.contacts == 0;
    const double begin = std::max(from_distance, run.first_contact_at);
    if (run.contacts > 0) from_first.push_back({std::max(0.0, ending.distance - begin), ending.is_clog});
  }
};

void fit_meetings(Group& group, const Meetings& meetings, double confidence) {
  group.clogging_met = fit::fit_clogging_length(meetings.from_first, confidence);
  group.num_free = meetings.num_free;
  if (meetings.way > 0) group.contacts_per_length = static_cast<double>(meetings.num_contacts) / meetings.way;
}

/// Counts by cause and their lengths; without values where they are not known.
void append_causes(const Group& group, std::vector<Field>& fields) {
  const Value unknown;
  for (std::size_t i = 0; i < std::size(cause_texts); ++i) {
    const CauseText& text = cause_texts[i];
    const bool known = !group.causes.empty();
    const fit::CloggingLength fit = known ? group.causes[i].ends : fit::CloggingLength();
    fields.emplace_back(text.count, known ? value_of(fit.num_clogs) : unknown);
    fields.emplace_back(text.length, known ? value_of(fit.length) : unknown);
    fields.emplace_back(text.lower, known ? value_of(fit.interval.lower) : unknown);
    fields.emplace_back(text.upper, known ? value_of(fit.interval.upper) : unknown);
  }
}

/// One or two runs that happened to come far enough to have a speed say little of all: their mean is not
/// told.
fit::MeanSpeed of_enough_runs(fit::MeanSpeed speed) {
  constexpr int fewest_runs = 3;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (speed.num_runs < fewest_runs) speed.mean = speed.standard_error = unknown;
  return speed;
}

/// Counts a run that ended by max-time although its droplet had long been at rest.
void add_rest(const sweep::RunRow& run, Group& group) {
  constexpr double diameters = 10;
  const double rest = run.time - run.dwells.last_begin;
  if (run.status != RunStatus::flowing || !(rest > diameters / run.parameters.drag.terminal_speed)) return;
  ++group.num_resting;
  group.shortest_rest = std::min(group.shortest_rest, rest);
}

/// The travel until the run ended or the droplet came to its arrest; not known in files without dwells.
fit::Travel travel_until_arrest(const sweep::RunRow& run) {
  const bool is_clogged = run.status == RunStatus::clogged;
  const double way = is_clogged ? run.dwells.last_distance : run.distance;
  return {way / run.parameters.drag.terminal_speed, is_clogged ? run.dwells.last_begin : run.time};
}

/// Droplets that sank by less than half a diameter on the average have no speed, as single ones.
fit::MeanSpeed mean_speed_of_all(std::span<const fit::Travel> travels, double terminal_speed) {
  constexpr double shortest_way = 0.5;  // [sigma]
  double way = 0;
  for (const fit::Travel& travel : travels) way += travel.distance * terminal_speed;
  const bool is_far = way >= shortest_way * static_cast<double>(travels.size());
  return of_enough_runs(is_far ? fit::fit_pooled_speed(travels) : fit::fit_pooled_speed({}));
}

/// Keeps the run with the largest max-time of each droplet (one seed in one array), sorted by max-time, the
/// largest first.
void keep_longest(std::vector<const sweep::RunRow*>& runs) {
  const auto longer = [](const sweep::RunRow* a, const sweep::RunRow* b) {
    return a->parameters.max_time > b->parameters.max_time;
  };
  std::stable_sort(runs.begin(), runs.end(), longer);
  std::set<std::pair<std::uint32_t, std::string>> known;
  std::erase_if(runs, [&](const sweep::RunRow* run) {
    if (run->status == RunStatus::failed || !sweep::fault_of(*run).empty()) return false;
    return !known.emplace(run->parameters.seed, sweep::array_key(run->parameters)).second;
  });
}

constexpr std::pair<std::string_view, std::string_view> units_of_results[] = {
    {"dwell", "t0"},
    {"total_distance", "sigma"},
    {"contacts_per_length", "1/sigma"},
    {"relative_speed", "v_t"},
    {"relative_speed_error", "v_t"},
    {"relative_speed_all", "v_t"},
    {"relative_speed_all_error", "v_t"},
    {"relative_speed_pooled", "v_t"},
    {"relative_speed_pooled_error", "v_t"}};

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

const DoubtText& text_of(Doubt doubt) {
  return *std::find_if(std::begin(doubt_texts), std::end(doubt_texts),
                       [=](const DoubtText& text) { return text.doubt == doubt; });
}

bool is_device(const RunParameters& run) {
  return scene_of(run).walls_from == WallsFrom::circles &&
         (run.obstacles.release == Release::entrance || run.obstacles.exit > 0);
}

bool is_dwell_possible(const Group& group) { return group.dwell < group.first_row.parameters.max_time; }

std::vector<const sweep::Column*> pooled_columns(const std::string& keys) {
  std::vector<const sweep::Column*> columns;
  for (const std::string& key : split_at_commas(keys)) {
    if (key != "max-time" && key != "boxes")
      throw Error(fmt::format(
          "invalid --pool={} (runs that differ in {} are runs of another droplet or another array) pool "
          "max-time and boxes only",
          keys, key));
    columns.push_back(&sweep::column(parameter(key).column));
  }
  return columns;
}

std::vector<Group> group_runs(std::span<const sweep::RunRow> rows, double confidence, double from_distance,
                              double dwell, std::span<const sweep::Column* const> pooled,
                              std::span<const double> lines) {
  require_dwells(rows, dwell);
  std::map<std::vector<Field>, std::vector<const sweep::RunRow*>> members;
  for (const sweep::RunRow& row : rows) {
    std::vector<Field> fields = parameter_fields(row);
    for (const sweep::Column* column : pooled)
      for (auto& [name, value] : fields)
        if (column->name == name) value = Value();
    members[std::move(fields)].push_back(&row);
  }
  std::vector<Group> groups;
  for (auto& [fields, runs] : members) {
    Group group;
    const std::size_t num_all = runs.size();
    if (!pooled.empty()) keep_longest(runs);
    group.num_repeated = static_cast<int>(num_all - runs.size());
    group.first_row = *runs.front();
    group.dwell = dwell;
    const bool is_of_device = is_device(group.first_row.parameters);
    std::vector<Ending> counted;
    std::vector<Arrival> arrivals;
    Meetings meetings;
    std::vector<double> speeds;
    std::vector<fit::Travel> travels, all_travels;
    std::vector<fit::Displacement> displacements;
    for (const sweep::RunRow* run : runs) {
      const bool is_damaged = !sweep::fault_of(*run).empty();
      const bool is_failed = !is_damaged && run->status == RunStatus::failed;
      group.num_damaged += is_damaged;
      group.num_failed += is_failed;
      if (is_damaged || is_failed) continue;
      Ending ending = ending_of(*run, dwell);
      group.num_interrupted += sweep::is_unfinished(run->status) && !ending.is_clog;
      if (run->steps > 0) group.dwells_known_from = later(group.dwells_known_from, run->dwells.known_from);
      group.num_repeating += sweep::has_met_repetition(*run);
      const Ending from_release = ending;
      if (is_of_device) {
        arrivals.push_back(arrival_of(*run, ending));
        ending.distance = distance_from_contact(*run, ending.distance);
      }
      const bool has_met_none = is_of_device && run->contacts == 0;
      const bool is_left_out = has_met_none || std::max(ending.distance, 0.0) < from_distance;
      group.num_left_out += is_left_out && !has_met_none;
      if (!is_left_out) counted.push_back(ending);
      if (!is_left_out) group.seeds.push_back(run->parameters.seed);
      if (!is_left_out || has_met_none) meetings.count(*run, from_release, from_distance);
      group.num_on_mesh += !is_left_out && sweep::may_hang_on_mesh(*run);
      group.num_passed += !is_left_out && !ending.is_clog && run->status == RunStatus::passed;
      group.num_flowing += !is_left_out && !ending.is_clog && run->status == RunStatus::flowing;
      if (!is_left_out && !ending.is_clog) add_rest(*run, group);
      const double relative_speed = run->mean_speed / run->parameters.drag.terminal_speed;
      speeds.push_back(relative_speed);
      travels.push_back({relative_speed * run->travel_time, run->travel_time});
      if (run->steps > 0) all_travels.push_back(travel_until_arrest(*run));
      displacements.push_back({run->distance, run->lateral_displacement});
    }
    fit_clogging(group, counted, confidence, from_distance);
    fit_meetings(group, meetings, confidence);
    if (is_of_device) group.passages = passages_of(group.first_row.parameters, arrivals, lines, confidence);
    group.relative_speed = of_enough_runs(fit::fit_mean_speed(speeds));
    group.relative_speed_pooled = of_enough_runs(fit::fit_pooled_speed(travels));
    group.relative_speed_all = mean_speed_of_all(all_travels, group.first_row.parameters.drag.terminal_speed);
    group.migration = fit::fit_migration(displacements);
    group.doubts = doubts_about(group);
    groups.push_back(std::move(group));
  }
  doubt_exponentiality(groups);
  return groups;
}

std::span<const sweep::Column* const> group_columns() {
  static const std::vector<const sweep::Column*> all = [] {
    std::vector<const sweep::Column*> columns;
    for (const sweep::Column& column : sweep::columns())
      if (column.role == sweep::ColumnRole::parameter && !is_ensemble(column)) columns.push_back(&column);
    std::stable_sort(columns.begin() + 1, columns.end(), [](const sweep::Column* a, const sweep::Column* b) {
      return std::pair(is_numerics(*a), !a->shapes_array) < std::pair(is_numerics(*b), !b->shapes_array);
    });
    return columns;
  }();
  return all;
}

std::vector<Field> parameter_fields(const sweep::RunRow& row) {
  std::vector<Field> fields;
  for (const sweep::Column* column : group_columns())
    fields.emplace_back(column->name.c_str(), column->get(row));
  return fields;
}

bool has_clogging_length(const sweep::RunRow& row) {
  return scene_of(row.parameters).finding == Finding::clogging_length;
}

std::vector<Field> result_fields(const Group& group) {
  const RunParameters& run = group.first_row.parameters;
  const double line_tension = run.model == Model::dp ? run.dp.line_tension : sweep::RunRow::not_known;
  std::string doubts;
  for (const Doubt doubt : group.doubts)
    doubts += std::string(doubts.empty() ? "" : " ") + text_of(doubt).word;
  std::vector<Field> fields = {
      {"runs", value_of(group.clogging.num_runs)},
      {"clogs", value_of(group.clogging.num_clogs)},
      {"passed", value_of(group.num_passed)},
      {"flowing", value_of(group.num_flowing)},
      {"interrupted", value_of(group.num_interrupted)},
      {"failed", value_of(group.num_failed)},
      {"damaged", value_of(group.num_damaged)},
      {"left_out", value_of(group.num_left_out)},
      {"repeated", value_of(group.num_repeated)},
      {"dwell", is_dwell_possible(group) ? value_of(group.dwell) : Value()},
      {"dwells_known_from", value_of(group.dwells_known_from)},
      {"repeating", value_of(group.num_repeating)},
      {"on_mesh", value_of(group.num_on_mesh)},
      {"total_distance", value_of(group.clogging.total_distance)},
      {"clogging_length", value_of(group.clogging.length)},
      {"clogging_length_lower", value_of(group.clogging.interval.lower)},
      {"clogging_length_upper", value_of(group.clogging.interval.upper)},
      {"clogging_length_profile_lower", value_of(group.clogging.profile.lower)},
      {"clogging_length_profile_upper", value_of(group.clogging.profile.upper)},
      {"clogging_length_least_squares", value_of(group.least_squares_length)},
      {"met_none", value_of(group.num_free)},
      {"contacts_per_length", value_of(group.contacts_per_length)},
      {"clogging_length_met", value_of(group.clogging_met.length)},
      {"clogging_length_met_lower", value_of(group.clogging_met.interval.lower)},
      {"clogging_length_met_upper", value_of(group.clogging_met.interval.upper)},
      {"weibull_shape", value_of(group.weibull.shape)},
      {"weibull_p_value", value_of(group.weibull.p_value)},
      {"relative_speed", value_of(group.relative_speed.mean)},
      {"relative_speed_error", value_of(group.relative_speed.standard_error)},
      {"relative_speed_runs", value_of(group.relative_speed.num_runs)},
      {"relative_speed_pooled", value_of(group.relative_speed_pooled.mean)},
      {"relative_speed_pooled_error", value_of(group.relative_speed_pooled.standard_error)},
      {"relative_speed_all", value_of(group.relative_speed_all.mean)},
      {"relative_speed_all_error", value_of(group.relative_speed_all.standard_error)},
      {"capillary_number", value_of(group.relative_speed.mean * units::droplet_mass / line_tension)},
      {"lateral_slope", value_of(group.migration.slope)},
      {"lateral_slope_error", value_of(group.migration.standard_error)},
      {"doubts", doubts}};
  append_causes(group, fields);
  if (has_clogging_length(group.first_row)) return fields;
  std::vector<Field> of_run = {{"interrupted", value_of(group.num_interrupted)},
                               {"failed", value_of(group.num_failed)},
                               {"damaged", value_of(group.num_damaged)},
                               {"doubts", doubts}};
  for (Field& field : fields_of_run(group.first_row)) of_run.push_back(std::move(field));
  return of_run;
}

}  // namespace clog::results

#include "clog/results/groups.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
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
#include "clog/core/tools/wording.hpp"
#include "clog/sweep/obstacle_arrays.hpp"
#include "clog/sweep/row_check.hpp"
#include "clog/sweep/row_limits.hpp"
#include "passages.hpp"

namespace clog::results {
namespace {

std::vector<double> censored_distances(std::span<const fit::Observation> runs) {
  std::vector<double> distances;
  for (const fit::Observation& run : runs)
    if (!run.clogged) distances.push_back(run.distance);
  std::sort(distances.begin(), distances.end());
  return distances;
}

/// The end of a run: its distance, and whether it is a clog.
struct Ending {
  double distance;  ///< [sigma]
  bool is_clog;
  std::optional<Cause> cause;  ///< cause of a clog, if it is known, or of a break-up
};

std::optional<Cause> cause_of(const sweep::RunRow& run) {
  if (run.status == RunStatus::broken) return Cause::broken;
  if (run.status != RunStatus::clogged || !run.hold.mechanism) return std::nullopt;
  switch (*run.hold.mechanism) {
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

/// Whether the run may have recorded dwells of this length. A run that has not begun has no dwells.
bool may_have_dwells(const sweep::RunRow& run, double dwell) {
  return dwell < run.parameters.max_time && run.steps > 0;
}

/// @param dwell  see group_runs()
Ending ending_of(const sweep::RunRow& run, double dwell) {
  const bool is_clogged = run.status == RunStatus::clogged;
  const double observed = sweep::observed_distance(run).value();
  const Ending last = {observed, is_clogged, cause_of(run)};
  if (!may_have_dwells(run, dwell)) return last;
  // A long rest counts as a clog with the cause `other`, because the mechanism is unknown if the droplet
  // moved on.
  const bool has_failed = run.status == RunStatus::failed;
  const Dwell* first = run.dwells.first_longer(dwell);
  if (first && (!has_failed || first->distance <= observed)) return {first->distance, true, Cause::other};
  if (is_clogged || last.cause) return last;
  return {has_failed ? std::min(run.dwells.last_distance, observed) : run.dwells.last_distance, false, {}};
}

/// See observation_of().
std::optional<Ending> ending_if_counted(const sweep::RunRow& run, Ending ending) {
  if (!is_device(run.parameters)) return ending;
  if (run.contacts.number == 0) return std::nullopt;
  if (sweep::is_known(run.contacts.number)) ending.distance -= run.contacts.first_distance;
  return ending;
}

/// The later of two times; NaN if one of them is NaN.
double later(double one, double other) { return std::isnan(one) || one > other ? one : other; }

/// Rounds up to three figures, so that users can type the number.
std::string rounded_up(double number) {
  const double unit = std::pow(10, std::floor(std::log10(number)) - 2);
  return fmt::format("{:.3g}", std::ceil(number / unit) * unit);
}

/// @throws Error if intact rows do not record which droplets rested for longer than `dwell`
void require_dwells(std::span<const sweep::RunRow> rows, double dwell) {
  int num_unknown = 0;
  double known_from = 0;
  for (const sweep::RunRow& row : rows) {
    if (!may_have_dwells(row, dwell) || dwell >= row.dwells.known_from) continue;
    if (!is_observed(row)) continue;  // the row is excluded
    num_unknown += !sweep::is_known(row.dwells.known_from);
    if (row.dwells.known_from > known_from) known_from = row.dwells.known_from;
  }
  if (num_unknown > 0)
    throw Error(fmt::format(
        "cannot fit --dwell={} ({} of a version that did not look for dwells); compute the sweep anew, into "
        "another file",
        shortest(dwell), count_text(num_unknown, "row")));
  if (known_from > 0)
    throw Error(
        fmt::format("cannot fit --dwell={} (the rows do not hold all dwells as short as that; column "
                    "dwells_known_from) use {} or more",
                    shortest(dwell), rounded_up(known_from)));
}

/// Fits clogging lengths to the intact runs that reached `from_distance`.
void fit_clogging(Group& group, std::span<const Ending> runs, double confidence, double from_distance) {
  if (!has_clogging_length(group.first_row)) return;
  // The ends that `is_end` selects count as events; all other runs are censored.
  const auto observe = [&](auto is_end) {
    std::vector<fit::Observation> observations;
    observations.reserve(runs.size());
    for (const Ending& run : runs) observations.push_back({run.distance - from_distance, is_end(run)});
    return observations;
  };
  const std::vector<fit::Observation>& all = group.runs =
      observe([](const Ending& run) { return run.is_clog; });
  group.clogging = fit::fit_clogging_length(all, confidence);
  group.least_squares_length = fit::least_squares_length(all);
  group.weibull = fit::test_exponentiality(all);
  group.survival = fit::survival_curve(all, confidence);
  group.censored_distances = censored_distances(all);
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
    one.incidence = fit::cumulative_incidence(competing, static_cast<int>(text.cause), confidence);
  }
}

/// The runs that met an obstacle. The distance of each run counts from its first obstacle.
struct Meetings {
  std::vector<fit::Observation> from_first;  ///< outcomes of the runs that met an obstacle
  std::int64_t num_contacts = 0;
  double way = 0;  ///< distance of all runs that record contacts [sigma]
  int num_free = 0;

  void count(const sweep::RunRow& run, const Ending& ending, double from_distance) {
    if (!sweep::is_known(run.contacts.number)) return;
    num_contacts += run.contacts.number;
    way += std::max(0.0, sweep::observed_distance(run).value());
    num_free += run.contacts.number == 0 && run.status != RunStatus::failed;
    const double begin = std::max(from_distance, run.contacts.first_distance);
    if (run.contacts.number > 0)
      from_first.push_back({std::max(0.0, ending.distance - begin), ending.is_clog});
  }
};

void fit_meetings(Group& group, const Meetings& meetings, double confidence) {
  group.clogging_met = fit::fit_clogging_length(meetings.from_first, confidence);
  group.num_free = meetings.num_free;
  if (meetings.way > 0) group.contacts_per_length = static_cast<double>(meetings.num_contacts) / meetings.way;
}

/// The mean speed, unless only one or two runs travelled far enough to have a speed, because these do not
/// represent all runs.
fit::MeanSpeed of_enough_runs(fit::MeanSpeed speed) {
  constexpr int fewest_runs = 3;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (speed.num_runs < fewest_runs) speed.mean = speed.standard_error = unknown;
  return speed;
}

/// Adds a run to the count of resting droplets, if max-time ended the run after a long rest.
void add_rest(const sweep::RunRow& run, Group& group) {
  constexpr double diameters = 10;
  const double rest = run.time - run.dwells.last_begin;
  if (run.status != RunStatus::flowing || !(rest > diameters / run.parameters.drag.terminal_speed)) return;
  ++group.num_resting;
  group.shortest_rest = std::min(group.shortest_rest, rest);
}

/// Distance and time of a run until its end or, if it clogged, until its last dwell began. Unknown in files
/// without dwells.
fit::Travel travel_until_arrest(const sweep::RunRow& run) {
  const bool is_clogged = run.status == RunStatus::clogged;
  const double way = is_clogged ? run.dwells.last_distance : run.distance;
  return {way / run.parameters.drag.terminal_speed, is_clogged ? run.dwells.last_begin : run.time};
}

/// The mean speed of a group; NaN if its droplets sank by less than half a diameter on average.
fit::MeanSpeed mean_speed_of_all(std::span<const fit::Travel> travels, double terminal_speed) {
  constexpr double shortest_way = 0.5;  // [sigma]
  double way = 0;
  for (const fit::Travel& travel : travels) way += travel.distance * terminal_speed;
  const bool is_far = way >= shortest_way * static_cast<double>(travels.size());
  return of_enough_runs(is_far ? fit::fit_pooled_speed(travels) : fit::fit_pooled_speed({}));
}

/// Keeps one run of each droplet (one seed in one array): the run with the largest max-time. A crash is kept
/// only if there is no other run, because it says less about the droplet.
void keep_longest(std::vector<const sweep::RunRow*>& runs) {
  std::ranges::stable_sort(runs, std::ranges::greater(), [](const sweep::RunRow* run) {
    return std::pair(!sweep::may_succeed_later(*run), run->parameters.max_time);
  });
  std::set<std::pair<std::uint32_t, std::string>> known;
  std::erase_if(runs, [&](const sweep::RunRow* run) {
    if (!is_observed(*run)) return false;
    return !known.emplace(run->parameters.seed, sweep::array_key(run->parameters)).second;
  });
}

/// Results of the intact runs of a group.
struct Tally {
  std::vector<Ending> endings;  ///< runs that count for the clogging length
  std::vector<double> clogs;    ///< distances of the clogs [sigma]
  /// Distances of runs that met an obstacle but did not clog [sigma]. Runs without obstacles on their path
  /// are excluded, because all of them have equal distances.
  std::vector<double> others;
  std::vector<Arrival> arrivals;
  Meetings meetings;
  std::vector<double> speeds;
  std::vector<fit::Travel> travels, travels_until_arrest, steady_travels;
  std::vector<fit::Displacement> displacements;
};

/// Includes a run in the clogging lengths, if it counts.
void add_ending(const sweep::RunRow& run, double from_distance, Group& group, Tally& tally) {
  const Ending from_release = ending_of(run, group.dwell);
  if (run.steps > 0) group.dwells_known_from = later(group.dwells_known_from, run.dwells.known_from);
  const std::optional<Ending> ending = ending_if_counted(run, from_release);
  group.num_interrupted += sweep::is_unfinished(run.status) && !from_release.is_clog;
  if (is_device(run.parameters)) {
    const double begin = start_of_path(run.parameters.obstacles, run.release[0]);
    tally.arrivals.push_back(
        {begin, begin + from_release.distance, from_release.is_clog || from_release.cause.has_value()});
    if (is_displaced(run.parameters, run.release[0], run.release[1])) group.displaced.push_back(begin);
  }
  const bool is_too_short = ending && std::max(ending->distance, 0.0) < from_distance;
  group.num_left_out += is_too_short;
  if (!is_too_short) tally.meetings.count(run, from_release, from_distance);
  if (is_too_short || !ending) return;
  tally.endings.push_back(*ending);
  if (ending->is_clog || run.contacts.number > 0)
    (ending->is_clog ? tally.clogs : tally.others).push_back(ending->distance);
  group.seeds.push_back(run.parameters.seed);
  group.num_on_mesh += sweep::may_hang_on_mesh(run);
  group.num_stability_unknown += run.stability == Stability::unknown;
  group.num_near_friction_limit += sweep::is_near_friction_limit(run);
  group.num_failed_counted += run.status == RunStatus::failed;
  if (ending->is_clog) return;
  group.num_passed += run.status == RunStatus::passed;
  group.num_flowing += run.status == RunStatus::flowing;
  add_rest(run, group);
}

void add_motion(const sweep::RunRow& run, Group& group, Tally& tally) {
  const double relative_speed = run.speed.mean / run.parameters.drag.terminal_speed;
  tally.speeds.push_back(relative_speed);
  tally.travels.push_back({relative_speed * run.speed.time, run.speed.time});
  tally.steady_travels.push_back({run.steady.distance / run.parameters.drag.terminal_speed, run.steady.time});
  tally.displacements.push_back({run.distance, run.lateral});
  group.num_repeating += sweep::has_met_repetition(run);
  if (run.steps > 0) tally.travels_until_arrest.push_back(travel_until_arrest(run));
}

/// Counts failed and damaged runs, and includes all runs that have an outcome (is_observed()). Failed runs
/// are excluded from speeds and lateral displacements, because the failure may have changed these before it
/// was detected.
Tally tally_of(std::span<const sweep::RunRow* const> runs, double from_distance, Group& group) {
  Tally tally;
  for (const sweep::RunRow* run : runs) {
    if (!sweep::fault_of(*run).empty()) {
      ++group.num_damaged;
      continue;
    }
    const bool has_failed = run->status == RunStatus::failed;
    group.num_failed += has_failed;
    group.num_failed_somewhere += !is_observed(*run);
    if (is_observed(*run)) add_ending(*run, from_distance, group, tally);
    if (!has_failed) add_motion(*run, group, tally);
  }
  return tally;
}

using Runs = std::vector<const sweep::RunRow*>;

/// Runs that differ only in their seed and in pooled columns.
std::map<std::vector<Value>, Runs> members_of_groups(std::span<const sweep::RunRow> rows,
                                                     std::span<const sweep::Column* const> pooled) {
  std::map<std::vector<Value>, Runs> members;
  for (const sweep::RunRow& row : rows) {
    std::vector<Value> values = parameter_values(row);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (std::ranges::find(pooled, group_columns()[i]) != pooled.end())
        values[i] = Value();
      else if (double* const number = std::get_if<double>(&values[i]))
        *number = twelve_digits(*number);
    members[std::move(values)].push_back(&row);
  }
  return members;
}

}  // namespace

std::string runs_of(sweep::RunRow row) {
  row.parameters.seed = 0;
  return sweep::identity_in_any_laboratory(std::move(row));
}

bool is_device(const RunParameters& run) {
  return scene_of(run).walls_from == WallsFrom::circles &&
         (run.obstacles.release == Release::entrance || run.obstacles.exit > 0);
}

bool is_observed(const sweep::RunRow& run) {
  return sweep::observed_distance(run) && sweep::fault_of(run).empty();
}

std::optional<fit::Observation> observation_of(const sweep::RunRow& run) {
  const std::optional<Ending> ending =
      ending_if_counted(run, ending_of(run, std::numeric_limits<double>::infinity()));
  return ending ? std::optional(fit::Observation{ending->distance, ending->is_clog}) : std::nullopt;
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

/// The families of the runs that are over and intact. The exit of a device is one of the lines.
static Families families_of(const std::vector<const sweep::RunRow*>& runs, double confidence,
                            std::span<const double> lines) {
  std::vector<ReleasedFamily> families;
  for (const sweep::RunRow* run : runs)
    if (!run->family.empty() && sweep::fault_of(*run).empty())
      families.push_back({run->family, is_device(run->parameters) ? run->release[0] : 0});
  std::vector<double> all_lines(lines.begin(), lines.end());
  if (const double exit = runs.front()->parameters.obstacles.exit; exit > 0) all_lines.push_back(exit);
  return families_of(families, confidence, all_lines);
}

bool have_families(const std::vector<Group>& groups) {
  return std::ranges::any_of(groups, [](const Group& group) { return group.families.num_ancestors > 0; });
}

std::vector<Group> group_runs(std::span<const sweep::RunRow> rows, double confidence, double from_distance,
                              double dwell, std::span<const sweep::Column* const> pooled,
                              const LinesOf& lines) {
  require_dwells(rows, dwell);
  std::vector<Group> groups;
  for (auto& [values, runs] : members_of_groups(rows, pooled)) {
    Group group;
    const std::size_t num_all = runs.size();
    if (!pooled.empty()) keep_longest(runs);
    group.num_repeated = static_cast<int>(num_all - runs.size());
    group.first_row = *runs.front();
    group.dwell = dwell;
    const RunParameters& run = group.first_row.parameters;
    const Tally tally = tally_of(runs, from_distance, group);
    fit_clogging(group, tally.endings, confidence, from_distance);
    // Distances at max-time are similar in all dilute arrays, so only clogs may be at one place.
    group.are_runs_equal = fit::are_mostly_equal(tally.clogs.empty() ? tally.others : tally.clogs) ||
                           fit::are_mostly_at_one_place(tally.clogs);
    fit_meetings(group, tally.meetings, confidence);
    const std::vector<double> own_lines = lines ? lines(group.first_row) : std::vector<double>();
    if (is_device(run)) group.passages = passages_of(run, tally.arrivals, own_lines, confidence);
    group.families = families_of(runs, confidence, own_lines);
    group.relative_speed = of_enough_runs(fit::fit_mean_speed(tally.speeds));
    group.relative_speed_pooled = of_enough_runs(fit::fit_pooled_speed(tally.travels));
    group.relative_speed_all = mean_speed_of_all(tally.travels_until_arrest, run.drag.terminal_speed);
    group.relative_speed_steady = of_enough_runs(fit::fit_pooled_speed(tally.steady_travels));
    group.migration = fit::fit_migration(tally.displacements);
    if (run.obstacles.layout == ObstacleLayout::lattice) group.row_angle = run.obstacles.lattice_angle;
    group.doubts = doubts_about(group);
    groups.push_back(std::move(group));
  }
  std::ranges::stable_sort(groups, {}, finding_of);
  doubt_exponentiality(groups);
  return groups;
}

}  // namespace clog::results

#include "clog/results/comparison.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "clog/console/printable.hpp"
#include "clog/console/rounded.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/fit/holm.hpp"
#include "clog/fit/log_rank.hpp"
#include "clog/results/selection.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/results/usual_parameters.hpp"
#include "clog/sweep/columns.hpp"
#include "clog/sweep/row_check.hpp"
#include "clog/sweep/row_limits.hpp"

namespace clog::results {
namespace {

using sweep::RunRow;

/// Runs that differ only in their seed.
struct ParameterSet {
  RunRow first;
  std::map<std::uint32_t, const RunRow*> by_seed;
};

std::vector<Value> column_values(const RunRow& row, const std::vector<std::string>& columns) {
  std::vector<Value> values;
  values.reserve(columns.size());
  for (const std::string& name : columns) values.push_back(sweep::column(name).get(row));
  return values;
}

std::vector<ParameterSet> sets_of(const std::vector<RunRow>& rows) {
  std::map<std::vector<Value>, ParameterSet> sets;
  for (const RunRow& row : rows) {
    if (!is_observed(row)) continue;
    ParameterSet& set = sets.try_emplace(parameter_values(row), ParameterSet{row, {}}).first->second;
    set.by_seed.emplace(row.parameters.seed, &row);
  }
  std::vector<ParameterSet> all;
  all.reserve(sets.size());
  for (auto& [values, set] : sets) all.push_back(std::move(set));
  return all;
}

std::set<Value> values_in(const std::vector<ParameterSet>& sets, const std::string& column) {
  std::set<Value> values;
  for (const ParameterSet& set : sets) values.insert(sweep::column(column).get(set.first));
  return values;
}

/// Columns by which parameter sets of two sides are matched. The values in such a column vary within a side,
/// and at least one value occurs on both sides.
std::vector<std::string> common_columns(const Side& there, const Side& here,
                                        const std::vector<ParameterSet>& sets_there,
                                        const std::vector<ParameterSet>& sets_here) {
  std::vector<std::string> columns;
  for (const sweep::Column* column : group_columns()) {
    const auto is_listed = [&](const Side& side) {
      return std::ranges::find(side.lists, column->name) != side.lists.end();
    };
    if (!is_listed(there) && !is_listed(here)) continue;
    const std::set<Value> values = values_in(sets_there, column->name);
    const bool is_common = std::ranges::any_of(values_in(sets_here, column->name),
                                               [&](const Value& value) { return values.contains(value); });
    if (is_common) columns.push_back(column->name);
  }
  return columns;
}

using ByValues = std::map<std::vector<Value>, const ParameterSet*>;

ByValues by_values(const std::vector<ParameterSet>& sets, const std::vector<std::string>& columns,
                   const Side& side) {
  ByValues all;
  for (const ParameterSet& set : sets) {
    const auto [known, is_new] = all.emplace(column_values(set.first, columns), &set);
    if (is_new) continue;
    std::vector<std::string> differing;
    for (const sweep::Column* column : group_columns())
      if (column->get(known->second->first) != column->get(set.first)) differing.push_back(column->name);
    throw Error(fmt::format(
        "cannot compare (several parameter sets of {0} differ only in {1}, and the other side has none of "
        "these values: it is not clear which set to compare); choose one with clogsweep select",
        side.name, joined(differing)));
  }
  return all;
}

/// Appends the parameter sets of a side whose values in Comparisons::columns no set of the other side has.
void append_unmatched(Comparisons& comparisons, const Side& side, const Side& compared_with,
                      const ByValues& own, const ByValues& others) {
  std::vector<std::vector<Value>> unmatched;
  for (const auto& [values, set] : own)
    if (!others.contains(values)) unmatched.push_back(values);
  append_left_out(comparisons, side.name, compared_with.name, comparisons.columns, unmatched, own.size());
}

std::vector<fit::Observation> observations(const ParameterSet& set) {
  std::vector<fit::Observation> all;
  all.reserve(set.by_seed.size());
  for (const auto& [seed, row] : set.by_seed)
    if (const std::optional<fit::Observation> one = observation_of(*row)) all.push_back(*one);
  return all;
}

Comparison compare_sets(const ParameterSet& here, const ParameterSet& there, double confidence,
                        double within) {
  Comparison comparison;
  std::vector<fit::Pair> pairs;
  std::size_t num_identical = 0;
  for (const auto& [seed, row] : here.by_seed) {
    const auto found = there.by_seed.find(seed);
    if (found == there.by_seed.end()) continue;
    const RunRow& other = *found->second;
    const std::optional<fit::Observation> one = observation_of(*row), the_other = observation_of(other);
    if (!one || !the_other) continue;
    const fit::Pair pair{*one, *the_other};
    const bool have_both = pair.here.clogged && pair.there.clogged;
    const bool is_same_place = have_both && std::abs(row->distance - other.distance) <= within &&
                               std::abs(row->lateral - other.lateral) <= within;
    comparison.num_both_clogged += have_both;
    comparison.num_same_place += is_same_place;
    num_identical += pair.here.clogged == pair.there.clogged && row->distance == other.distance &&
                     row->lateral == other.lateral;
    pairs.push_back(pair);
    pairs.back().is_alike = is_same_place || (!pair.here.clogged && !pair.there.clogged);
  }
  const std::vector<fit::Observation> all_here = observations(here), all_there = observations(there);
  comparison.length_here = fit::fit_clogging_length(all_here, confidence);
  comparison.length_there = fit::fit_clogging_length(all_there, confidence);
  comparison.ratio = fit::fit_length_ratio(all_here, all_there, pairs, confidence);
  comparison.log_rank_p = fit::log_rank_p_value(all_here, all_there);
  comparison.are_identical =
      num_identical == all_here.size() && num_identical == all_there.size() && num_identical > 0;
  return comparison;
}

/// The numbers that distinguish droplets in the cell of a laboratory: diameter [mm] and tilt [degrees].
std::pair<double, double> droplet_of(const LaboratoryScale& scale) { return {scale.length, scale.tilt}; }

/// Columns in which all compared sets differ, except automatic values.
std::vector<std::string> differing_columns(
    const std::vector<std::pair<const RunRow*, const RunRow*>>& pairs) {
  std::vector<std::string> columns;
  for (const sweep::Column* column : group_columns())
    if (std::ranges::all_of(pairs, [&](const auto& pair) {
          return separating_value(*column, *pair.first) != separating_value(*column, *pair.second);
        }))
      columns.push_back(column->name);
  return columns;
}

/// Names each comparison by its droplet, and gives its lengths in mm. @see compare()
void name_droplets(Comparisons& comparisons,
                   const std::vector<std::pair<const RunRow*, const RunRow*>>& compared,
                   const ScalesByLaboratory& scales) {
  const auto scale_of = [&](const RunRow* row) -> const LaboratoryScale& { return scale_in(scales, *row); };
  std::vector<const RunRow*> rows;
  for (const auto& [here, there] : compared) {
    if (droplet_of(scale_of(here)) != droplet_of(scale_of(there))) return;
    rows.push_back(here);
  }
  std::vector<std::string> columns = {"diameter", "angle"};
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < comparisons.columns.size(); ++i)
    if (!follows_from_droplet(sweep::column(comparisons.columns[i]), rows, scales)) {
      kept.push_back(i);
      columns.push_back(comparisons.columns[i]);
    }
  for (std::size_t i = 0; i < comparisons.all.size(); ++i) {
    Comparison& one = comparisons.all[i];
    const LaboratoryScale& scale = scale_of(rows[i]);
    std::vector<Value> common = {twelve_digits(scale.length), scale.tilt};
    for (const std::size_t place : kept) common.push_back(one.common[place]);
    one.common = std::move(common);
    for (fit::CloggingLength* length : {&one.length_here, &one.length_there}) {
      length->length *= scale.length;
      length->interval.lower *= scale.length;
      length->interval.upper *= scale.length;
    }
  }
  comparisons.columns = std::move(columns);
  comparisons.unit = "mm";
}

}  // namespace

const LaboratoryScale& scale_in(const ScalesByLaboratory& scales, const RunRow& row) {
  const auto of_all = scales.find("");
  return of_all != scales.end() ? of_all->second : scales.at(row.parameters.laboratory->check_sum());
}

std::map<std::vector<Value>, Flaws> flaws_by_parameters(const std::vector<RunRow>& rows, double confidence) {
  std::map<std::vector<Value>, Flaws> all;
  for (Group& group : group_runs(rows, confidence))
    all[parameter_values(group.first_row)] = {.num_failed = group.num_failed,
                                              .doubts = std::move(group.doubts),
                                              .weibull = group.weibull,
                                              .runs = runs_of(group.first_row)};
  return all;
}

int number_of(const Flaws& group, std::map<std::string, int>& known, int& num_groups) {
  if (group.runs.empty()) return num_groups++;
  const auto [place, is_new] = known.emplace(group.runs, num_groups);
  num_groups += is_new ? 1 : 0;
  return place->second;
}

std::string named_value(const std::string& column, const Value& value) {
  const std::string text = console::printable(sweep::text_of(value));
  return text.empty() ? "no " + column : fmt::format("{}={}", column, text);
}

void append_left_out(Comparisons& comparisons, const std::string& side, const std::string& other,
                     const std::vector<std::string>& labels, const std::vector<std::vector<Value>>& unmatched,
                     std::size_t number_of_all) {
  if (unmatched.empty()) return;
  std::vector<std::string> words;
  words.reserve(labels.size());
  for (std::size_t i = 0; i < labels.size(); ++i)
    words.push_back(named_value(labels[i], unmatched.front()[i]));
  comparisons.left_out.push_back({.side = side,
                                  .other = other,
                                  .number = unmatched.size(),
                                  .number_of_all = number_of_all,
                                  .example = joined(words)});
}

void correct_tests(Comparisons& all) {
  std::vector<Comparison>& comparisons = all.all;
  std::map<int, fit::WeibullTest> groups;
  std::vector<double> log_rank;
  std::map<std::pair<int, int>, std::size_t> tests_of_pairs;
  std::vector<std::size_t> test_of;
  for (const Comparison& one : comparisons) {
    for (const Flaws* flaws : {&one.flaws_here, &one.flaws_there}) groups[flaws->group] = flaws->weibull;
    const auto [known, is_new] =
        tests_of_pairs.emplace(std::pair(one.flaws_here.group, one.flaws_there.group), log_rank.size());
    if (is_new) log_rank.push_back(one.log_rank_p);
    test_of.push_back(known->second);
  }
  std::vector<fit::WeibullTest> tests;
  tests.reserve(groups.size());
  for (const auto& [group, test] : groups) tests.push_back(test);
  const std::vector<bool> are_not = fit::are_not_exponential(tests);
  const std::vector<double> adjusted = fit::holm_adjusted(log_rank);
  all.num_tests = std::ranges::count_if(log_rank, [](double p) { return !std::isnan(p); });
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    comparisons[i].log_rank_p_holm = adjusted[test_of[i]];
    for (Flaws* flaws : {&comparisons[i].flaws_here, &comparisons[i].flaws_there}) {
      const auto place = std::distance(groups.begin(), groups.find(flaws->group));
      const bool is_marked = std::ranges::find(flaws->doubts, Doubt::not_exponential) != flaws->doubts.end();
      if (!are_not[static_cast<std::size_t>(place)])
        std::erase(flaws->doubts, Doubt::not_exponential);
      else if (!is_marked)
        flaws->doubts.push_back(Doubt::not_exponential);
    }
  }
}

bool follows_from_droplet(const sweep::Column& column, const std::vector<const sweep::RunRow*>& rows,
                          const ScalesByLaboratory& scales) {
  const bool is_scaled = !column.unit.empty() && column.unit != "degrees";
  if (!is_scaled && !column.holds_check_sum()) return false;
  std::map<std::pair<double, double>, Value> known;
  return std::ranges::all_of(rows, [&](const RunRow* row) {
    const Value value = separating_value(column, *row);
    return known.try_emplace(droplet_of(scale_in(scales, *row)), value).first->second == value;
  });
}

void require_lengths(const Side& side) {
  if (side.rows.empty()) throw Error("no runs yet in " + side.name + "; start or resume the sweep");
  if (!std::ranges::all_of(side.rows, has_clogging_length))
    throw Error("cannot compare " + side.name +
                " (droplets in a channel or on a wall have no clogging length); clogsweep select takes the "
                "others, if there are any");
}

std::vector<Side> sides_of_files(const std::vector<std::string>& paths) {
  std::vector<Side> sides;
  for (const std::string& path : paths) {
    store::SweepFile file = read_with_caution(path);
    sides.push_back({console::printable(path), std::move(file.rows), listed_columns(file.provenance)});
  }
  return sides;
}

std::vector<Side> sides_of_column(const std::string& name, const store::SweepFile& file) {
  std::string column = name;
  std::ranges::replace(column, '-', '_');
  const auto columns = group_columns();
  if (std::ranges::none_of(columns, [&](const sweep::Column* one) { return one->name == column; })) {
    std::vector<std::string> names;
    for (const sweep::Column* one : columns) names.push_back(one->name);
    const std::string meant = did_you_mean(column, names);
    throw Error(fmt::format("invalid --by={} (no parameter of a run){}", name, hint_at_column(name, meant)));
  }
  std::map<Value, std::vector<RunRow>> rows;
  for (const RunRow& row : file.rows) rows[sweep::column(column).get(row)].push_back(row);
  if (rows.size() < 2)
    throw Error(fmt::format(
        "invalid --by={} (all runs have the same) give a parameter that varies, or another file", name));
  std::vector<std::string> lists = listed_columns(file.provenance);
  std::erase(lists, column);
  std::vector<Side> sides;
  sides.reserve(rows.size());
  for (auto& [value, own] : rows) sides.push_back({named_value(column, value), std::move(own), lists});
  return sides;
}

Comparisons compare(const std::vector<Side>& sides, double confidence, std::optional<double> within,
                    const ScalesByLaboratory& scales) {
  if (sides.size() < 2) throw std::invalid_argument("a comparison has two sides or more");
  for (const Side& side : sides) require_lengths(side);
  Comparisons comparisons;
  comparisons.confidence = confidence;
  comparisons.within = within.value_or(0);
  std::vector<std::pair<const RunRow*, const RunRow*>> compared;
  const Side& there = sides.front();
  const std::vector<ParameterSet> sets_there = sets_of(there.rows);
  int num_groups = 0;
  const auto numbered_flaws = [&](const Side& side) {
    auto all = flaws_by_parameters(side.rows, confidence);
    std::map<std::string, int> known;
    for (auto& [values, flaws] : all) flaws.group = number_of(flaws, known, num_groups);
    return all;
  };
  const auto flaws_there = numbered_flaws(there);
  std::vector<std::vector<ParameterSet>> sets_here;
  sets_here.reserve(sides.size());  // `compared` points into them
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const Side& here = sides[i];
    sets_here.push_back(sets_of(here.rows));
    const std::vector<std::string> columns = common_columns(there, here, sets_there, sets_here.back());
    if (i == 1) comparisons.columns = columns;
    if (columns != comparisons.columns)
      throw Error(
          fmt::format("cannot compare {} (it varies {}, but {} varies {}); compare two at a time, "
                      "chosen with clogsweep select",
                      here.name, columns.empty() ? "nothing" : joined(columns), sides[1].name,
                      comparisons.columns.empty() ? "nothing" : joined(comparisons.columns)));
    const ByValues all_there = by_values(sets_there, columns, there);
    const auto flaws_here = numbered_flaws(here);
    const ByValues all_here = by_values(sets_here.back(), columns, here);
    append_unmatched(comparisons, here, there, all_here, all_there);
    append_unmatched(comparisons, there, here, all_there, all_here);
    for (const auto& [values, set] : all_here) {
      const auto other = all_there.find(values);
      if (other == all_there.end()) continue;
      const double near = within.value_or(sweep::obstacle_spacing(set->first) / 2);
      Comparison one = compare_sets(*set, *other->second, confidence, near);
      one.flaws_here = flaws_here.at(parameter_values(set->first));
      one.flaws_there = flaws_there.at(parameter_values(other->second->first));
      one.here = here.name;
      one.there = there.name;
      one.common = values;
      comparisons.all.push_back(std::move(one));
      compared.emplace_back(&set->first, &other->second->first);
    }
  }
  if (comparisons.all.empty())
    throw Error(fmt::format(
        "cannot compare {} with {} (no parameter set of one has the values of any set of the other)",
        sides[1].name, there.name));
  correct_tests(comparisons);
  comparisons.differing = differing_columns(compared);
  if (scales.size() > 1) name_droplets(comparisons, compared, scales);
  return comparisons;
}

}  // namespace clog::results

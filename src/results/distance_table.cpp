#include "clog/results/distance_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/fit/log_rank.hpp"
#include "clog/results/usual_parameters.hpp"

namespace clog::results {
namespace {

bool has_label(const std::vector<std::string>& labels, const std::string& name) {
  return std::ranges::find(labels, label_key(name), label_key) != labels.end();
}

std::optional<double> number_in(const Value& value) {
  if (const auto* count = std::get_if<std::int64_t>(&value)) return static_cast<double>(*count);
  const auto* number = std::get_if<double>(&value);
  return number ? std::optional(*number) : std::nullopt;
}

/// Whether two labels are the same. Numbers are compared to three digits, because a user may have rounded
/// them.
bool are_alike(const Value& one, const Value& other) {
  constexpr double rounding = 0.005;
  const std::optional<double> number = number_in(one), number_there = number_in(other);
  return number && number_there ? std::abs(*number - *number_there) <= rounding * std::abs(*number_there)
                                : one == other;
}

bool has_diameter_like(const DistanceTable& table, double sigma_mm) {
  return std::ranges::all_of(table.groups, [&](const DistanceGroup& group) {
    const std::optional<double> own = diameter_of(table, group, sigma_mm);
    return own && are_alike(Value(*own), Value(sigma_mm));
  });
}

/// Whether two groups have the same distances, in any order.
bool are_same(const std::vector<fit::Observation>& here, const std::vector<fit::Observation>& there) {
  const auto sorted = [](const std::vector<fit::Observation>& runs) {
    std::vector<std::pair<double, bool>> all;
    all.reserve(runs.size());
    for (const fit::Observation& run : runs) all.emplace_back(run.distance, run.clogged);
    std::ranges::sort(all);
    return all;
  };
  return sorted(here) == sorted(there);
}

/// How the groups of two tables match.
struct Match {
  std::vector<std::string> columns;  ///< labels of the first table, then those that only the second table has
  std::vector<std::pair<std::size_t, std::size_t>> common;  ///< places of a common label in the two tables
  std::vector<std::size_t> only_there;

  bool have_common_labels(const DistanceGroup& here, const DistanceGroup& there) const {
    return std::ranges::all_of(common, [&](const auto& pair) {
      return are_alike(here.labels[pair.first], there.labels[pair.second]);
    });
  }
};

Match match_of(const DistanceTable& here, const DistanceTable& there) {
  Match match{.columns = here.labels, .common = {}, .only_there = {}};
  for (std::size_t i = 0; i < there.labels.size(); ++i) {
    const auto same = std::ranges::find(here.labels, label_key(there.labels[i]), label_key);
    if (same != here.labels.end()) {
      match.common.emplace_back(same - here.labels.begin(), i);
    } else {
      match.only_there.push_back(i);
      match.columns.push_back(there.labels[i]);
    }
  }
  return match;
}

/// @param matched  places of the groups that match a group of the other table
void append_unmatched(Comparisons& comparisons, const DistanceTable& table,
                      const DistanceTable& compared_with, const std::set<std::size_t>& matched) {
  std::vector<std::vector<Value>> unmatched;
  for (std::size_t i = 0; i < table.groups.size(); ++i)
    if (!matched.contains(i)) unmatched.push_back(table.groups[i].labels);
  append_left_out(comparisons, table.source, compared_with.source, table.labels, unmatched,
                  table.groups.size());
}

}  // namespace

std::string label_key(std::string label) {
  std::ranges::replace(label, '-', '_');
  return label;
}

std::optional<double> diameter_of(const DistanceTable& table, const DistanceGroup& group,
                                  std::optional<double> sigma_mm) {
  const auto place = std::ranges::find(table.labels, "diameter");
  if (place == table.labels.end()) return sigma_mm;
  return number_in(group.labels[static_cast<std::size_t>(place - table.labels.begin())]);
}

std::vector<std::string> unmatched_labels(const DistanceTable& table, const DistanceTable& other) {
  std::vector<std::string> unmatched = table.labels;
  std::erase_if(unmatched, [&](const std::string& label) { return has_label(other.labels, label); });
  return unmatched;
}

DistanceTable counted_from(double from, DistanceTable table) {
  int num_left_out = 0;
  for (DistanceGroup& group : table.groups) {
    num_left_out += static_cast<int>(
        std::erase_if(group.runs, [=](const fit::Observation& run) { return run.distance < from; }));
    for (fit::Observation& run : group.runs) run.distance -= from;
  }
  table.from = from;
  if (num_left_out > 0)
    console::say(fmt::format("clogfit lengths: {}: left out, {} that ended before --from-distance={} {}",
                             table.source, count_text(num_left_out, "droplet"), shortest(from), table.unit));
  return table;
}

std::vector<DistanceTable> tables_of_values(const DistanceTable& table, const std::string& label) {
  const auto found = std::ranges::find(table.labels, label_key(label), label_key);
  if (found == table.labels.end())
    throw Error(
        fmt::format("invalid --by={} (no column of {}, besides distance and clogged); its columns are {}",
                    label, table.source, joined(table.labels)));
  const auto place = found - table.labels.begin();
  std::map<Value, DistanceTable> tables;
  for (DistanceGroup group : table.groups) {
    const Value value = group.labels[static_cast<std::size_t>(place)];
    DistanceTable& one = tables[value];
    if (one.groups.empty()) {
      one = {.source = named_value(*found, value),
             .unit = table.unit,
             .labels = table.labels,
             .groups = {},
             .is_measured = true};
      one.labels.erase(one.labels.begin() + place);
    }
    group.labels.erase(group.labels.begin() + place);
    one.groups.push_back(std::move(group));
  }
  if (tables.size() < 2)
    throw Error(fmt::format("invalid --by={} (all droplets have the same) give a column that varies", label));
  std::vector<DistanceTable> all;
  all.reserve(tables.size());
  for (auto& [value, one] : tables) all.push_back(std::move(one));
  return all;
}

DistanceTable distances_of(const Side& side, const ScalesByLaboratory& scales,
                           const std::vector<std::string>& asked, double confidence) {
  require_lengths(side);
  const bool is_in_mm =
      scales.size() > 1 || (!scales.empty() && (has_label(asked, "diameter") || has_label(asked, "angle")));
  DistanceTable table{.source = side.name, .unit = is_in_mm ? "mm" : "sigma", .labels = {}, .groups = {}};
  std::vector<const sweep::RunRow*> rows;
  for (const sweep::RunRow& row : side.rows)
    if (is_observed(row)) rows.push_back(&row);
  std::vector<const sweep::Column*> varying;
  for (const sweep::Column* column : group_columns())
    if (has_label(asked, column->name) || std::ranges::any_of(rows, [&](const sweep::RunRow* row) {
          return separating_value(*column, *row) != separating_value(*column, *rows.front());
        }))
      varying.push_back(column);
  if (is_in_mm)
    std::erase_if(varying, [&](const sweep::Column* column) {
      return !has_label(asked, column->name) && follows_from_droplet(*column, rows, scales);
    });
  for (const sweep::Column* column : varying) table.labels.push_back(column->name);
  if (is_in_mm) table.labels.insert(table.labels.end(), {"diameter", "angle"});
  const auto labels_of = [&](const sweep::RunRow& row) {
    std::vector<Value> labels;
    labels.reserve(varying.size());
    for (const sweep::Column* column : varying) labels.push_back(column->get(row));
    if (is_in_mm) {
      const LaboratoryScale& scale = scale_in(scales, row);
      labels.insert(labels.end(), {twelve_digits(scale.length), scale.tilt});
    }
    return labels;
  };
  std::map<std::vector<Value>, std::vector<fit::Observation>> runs;
  for (const sweep::RunRow* row : rows) {
    std::optional<fit::Observation> run = observation_of(*row);
    if (!run) continue;
    if (is_in_mm) run->distance *= scale_in(scales, *row).length;
    runs[labels_of(*row)].push_back(*run);
  }
  for (auto& [labels, own] : runs) table.groups.push_back({labels, std::move(own), {}});
  std::map<std::vector<Value>, Flaws> flaws;
  for (const Group& group : group_runs(side.rows, confidence)) {
    Flaws& all = flaws[labels_of(group.first_row)];
    all.num_failed += group.num_failed;
    for (const Doubt doubt : group.doubts)
      if (std::ranges::find(all.doubts, doubt) == all.doubts.end()) all.doubts.push_back(doubt);
  }
  for (DistanceGroup& group : table.groups) group.flaws = flaws[group.labels];
  return table;
}

Comparisons compare_distances(const std::vector<DistanceTable>& tables, double confidence,
                              std::optional<double> sigma_mm) {
  const DistanceTable& there = tables.front();
  const std::optional<double> given_sigma = sigma_mm;
  const bool are_units_equal =
      std::ranges::all_of(tables, [&](const DistanceTable& table) { return table.unit == there.unit; });
  // Distances in droplet diameters are ambiguous if a sweep has several droplets.
  const auto knows_diameters = [&](const DistanceTable& table) {
    return (sigma_mm || table.is_measured) &&
           std::ranges::all_of(table.groups, [&](const DistanceGroup& group) {
             return diameter_of(table, group, sigma_mm).has_value();
           });
  };
  for (const DistanceTable& table : tables) {
    const DistanceTable& in_mm = table.unit == "mm" ? table : there;
    if (table.unit == there.unit || knows_diameters(in_mm)) continue;
    throw Error(
        fmt::format("cannot compare {} with {} (one is in mm, the other in droplet diameters); {}",
                    table.source, there.source,
                    !in_mm.is_measured
                        ? "the sweep has several droplets: give distances in mm, and a column diameter [mm]"
                    : has_label(in_mm.labels, "diameter")
                        ? "fill the empty cells of the column diameter, or delete these rows"
                        : "give the droplet's diameter by --lab lab.cfg"));
  }
  if (sigma_mm && !std::ranges::all_of(tables, [&](const DistanceTable& table) {
        return has_diameter_like(table, *sigma_mm);
      }))
    sigma_mm.reset();  // the groups have several sizes
  Comparisons comparisons;
  comparisons.confidence = confidence;
  comparisons.unit = sigma_mm || !are_units_equal ? "sigma" : there.unit;
  comparisons.sigma_mm = sigma_mm;
  const auto runs_of = [&](const DistanceTable& table, const DistanceGroup& group) {
    std::vector<fit::Observation> runs = group.runs;
    if (table.unit != comparisons.unit)
      for (fit::Observation& run : runs) run.distance /= diameter_of(table, group, given_sigma).value();
    return runs;
  };
  int num_groups = 0;
  const auto numbered_flaws = [&](const DistanceTable& table) {
    std::vector<Flaws> all = flaws_of(table);
    std::map<std::string, int> known;
    for (Flaws& flaws : all) flaws.group = number_of(flaws, known, num_groups);
    return all;
  };
  const std::vector<Flaws> flaws_there = numbered_flaws(there);
  for (std::size_t i = 1; i < tables.size(); ++i) {
    const DistanceTable& here = tables[i];
    const Match match = match_of(here, there);
    const std::vector<Flaws> flaws_here = numbered_flaws(here);
    if (i == 1) comparisons.columns = match.columns;
    if (match.columns != comparisons.columns)
      throw Error(
          fmt::format("cannot compare {} (its groups differ in {}, those of {} in {}); compare two "
                      "files at a time",
                      here.source, joined(match.columns), tables[1].source, joined(comparisons.columns)));
    std::set<std::size_t> matched_here, matched_there;
    for (std::size_t place = 0; place < here.groups.size(); ++place)
      for (std::size_t other_place = 0; other_place < there.groups.size(); ++other_place) {
        const DistanceGroup &one = here.groups[place], &other = there.groups[other_place];
        if (!match.have_common_labels(one, other)) continue;
        matched_here.insert(place);
        matched_there.insert(other_place);
        Comparison comparison{.here = here.source, .there = there.source, .common = one.labels};
        comparison.flaws_here = flaws_here[place];
        comparison.flaws_there = flaws_there[other_place];
        for (const std::size_t label : match.only_there) comparison.common.push_back(other.labels[label]);
        const std::vector<fit::Observation> runs = runs_of(here, one), others = runs_of(there, other);
        comparison.length_here = fit::fit_clogging_length(runs, confidence);
        comparison.length_there = fit::fit_clogging_length(others, confidence);
        comparison.ratio = fit::fit_length_ratio(runs, others, {}, confidence);
        comparison.log_rank_p = fit::log_rank_p_value(runs, others);
        comparison.are_identical = runs.size() > 1 && are_same(runs, others);
        comparisons.all.push_back(std::move(comparison));
      }
    append_unmatched(comparisons, here, there, matched_here);
    append_unmatched(comparisons, there, here, matched_there);
  }
  if (comparisons.all.empty()) {
    std::vector<std::string> common = there.labels;
    std::erase_if(common, [&](const std::string& label) { return !has_label(tables[1].labels, label); });
    throw Error(
        fmt::format("cannot compare {} with {} (no group of one has the labels of a group of the other); "
                    "both need the same values of {}",
                    tables[1].source, there.source, joined(common)));
  }
  correct_tests(comparisons);
  return comparisons;
}

}  // namespace clog::results

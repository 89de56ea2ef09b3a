#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "clog/console/build_info.hpp"
#include "clog/console/json_text.hpp"
#include "clog/console/rounded.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/fit/survival.hpp"
#include "clog/results/distance_table.hpp"
#include "clog/results/groups.hpp"
#include "value_json.hpp"

namespace clog::results {
namespace {

/// Results of the distances of a group.
struct Lengths {
  fit::CloggingLength clogging;
  double least_squares = 0;
  fit::WeibullTest weibull;
  std::vector<Doubt> doubts;
};

std::vector<Lengths> lengths_of(const DistanceTable& table, double confidence) {
  const std::vector<Flaws> flaws = flaws_of(table);
  std::vector<Lengths> all;
  for (std::size_t i = 0; i < table.groups.size(); ++i) {
    const std::vector<fit::Observation>& runs = table.groups[i].runs;
    all.push_back({.clogging = fit::fit_clogging_length(runs, confidence),
                   .least_squares = fit::least_squares_length(runs),
                   .weibull = fit::test_exponentiality(runs),
                   .doubts = flaws[i].doubts});
  }
  return all;
}

/// A unit of lengths. It has a suffix for names and, for each group, a factor from the table's unit. The
/// factor is NaN if the droplet's diameter is unknown.
struct Unit {
  const char *suffix, *text;
  std::vector<double> factors;
};

/// The units of the results. The table's own unit comes first. The other unit is included if the diameter is
/// known in at least one group.
std::vector<Unit> units_of(const DistanceTable& table, std::optional<double> sigma_mm) {
  const bool is_in_mm = table.unit == "mm";
  const std::vector<double> ones(table.groups.size(), 1);
  std::vector<double> factors;
  for (const DistanceGroup& group : table.groups) {
    const double sigma = diameter_of(table, group, sigma_mm).value_or(sweep::RunRow::not_known);
    factors.push_back(is_in_mm ? 1 / sigma : sigma);
  }
  std::vector<Unit> units = {is_in_mm ? Unit{"_mm", "mm", ones} : Unit{"", "sigma", ones}};
  if (!std::ranges::all_of(factors, [](double factor) { return std::isnan(factor); }))
    units.push_back(is_in_mm ? Unit{"", "sigma", std::move(factors)} : Unit{"_mm", "mm", std::move(factors)});
  return units;
}

std::array<std::string, 2> length_cells(const fit::CloggingLength& clogging, double factor) {
  if (std::isnan(factor) || clogging.num_runs == 0) return {"-", "-"};
  const double lower = factor * clogging.interval.lower, upper = factor * clogging.interval.upper;
  if (clogging.num_clogs == 0) return {"> " + console::plain(lower), "-"};
  const auto rounded = console::with_interval(factor * clogging.length, lower, upper);
  return {rounded.value, rounded.lower + " .. " + rounded.upper};
}

std::vector<Field> fields_of(const DistanceTable& table, std::size_t group, const Lengths& lengths,
                             const std::vector<Unit>& units, double confidence) {
  const fit::CloggingLength& clogging = lengths.clogging;
  std::vector<Field> fields;
  for (std::size_t i = 0; i < table.labels.size(); ++i)
    fields.push_back({table.labels[i], table.groups[group].labels[i], "", table.labels[i]});
  fields.push_back({"runs", std::int64_t{clogging.num_runs}, "", "runs"});
  fields.push_back({"clogs", std::int64_t{clogging.num_clogs}, "", "clogs"});
  for (const Unit& unit : units) {
    const auto [length, interval] = length_cells(clogging, unit.factors[group]);
    const auto add = [&](const std::string& name, double value, const std::string& head = "",
                         const std::string& text = "") {
      fields.push_back({name + unit.suffix, finite_value(unit.factors[group] * value), "", head, text});
    };
    add("total_distance", clogging.total_distance);
    add("clogging_length", clogging.length, fmt::format("lambda/{}", unit.text), length);
    add("clogging_length_lower", clogging.interval.lower, fmt::format("{:g} %", 100 * confidence), interval);
    add("clogging_length_upper", clogging.interval.upper);
    add("clogging_length_profile_lower", clogging.profile.lower);
    add("clogging_length_profile_upper", clogging.profile.upper);
    add("clogging_length_least_squares", lengths.least_squares);
  }
  fields.push_back({"weibull_shape", finite_value(lengths.weibull.shape)});
  fields.push_back({"weibull_p_value", finite_value(lengths.weibull.p_value)});
  fields.push_back({"doubts", words_of(lengths.doubts), "", "note", letters_of(lengths.doubts)});
  return fields;
}

std::vector<std::vector<Field>> rows_of(const DistanceTable& table, const std::vector<Lengths>& lengths,
                                        std::optional<double> sigma_mm, double confidence) {
  const std::vector<Unit> units = units_of(table, sigma_mm);
  std::vector<std::vector<Field>> rows;
  for (std::size_t i = 0; i < lengths.size(); ++i)
    rows.push_back(fields_of(table, i, lengths[i], units, confidence));
  return rows;
}

/// All fields of a group, and its survival curve.
nlohmann::ordered_json entry_of(const std::vector<Field>& fields, const std::vector<fit::Observation>& runs,
                                double confidence) {
  nlohmann::ordered_json entry = json_of(fields);
  entry["survival"] = entry["censored_distances"] = nlohmann::ordered_json::array();
  for (const fit::SurvivalStep& step : fit::survival_curve(runs, confidence))
    entry["survival"].push_back(step_json(step, "clogs", step.num_clogs));
  std::vector<double> censored;
  for (const fit::Observation& run : runs)
    if (!run.clogged) censored.push_back(run.distance);
  std::ranges::sort(censored);
  entry["censored_distances"] = censored;
  return entry;
}

}  // namespace

std::vector<Flaws> flaws_of(const DistanceTable& table) {
  std::vector<Flaws> all;
  std::vector<fit::WeibullTest> tests;
  for (const DistanceGroup& group : table.groups) {
    tests.push_back(fit::test_exponentiality(group.runs));
    Flaws& one = all.emplace_back(group.flaws);
    one.weibull = tests.back();
    if (table.is_measured && tests.back().num_clogs < enough_clogs) one.doubts.push_back(Doubt::few_clogs);
  }
  if (!table.is_measured) return all;
  const std::vector<bool> are_not = fit::are_not_exponential(tests);
  for (std::size_t i = 0; i < tests.size(); ++i) {
    if (are_not[i]) all[i].doubts.push_back(Doubt::not_exponential);
    std::vector<double> clogs;
    for (const fit::Observation& run : table.groups[i].runs)
      if (run.clogged) clogs.push_back(run.distance);
    if (fit::are_mostly_equal(clogs) || fit::are_mostly_at_one_place(clogs))
      all[i].doubts.push_back(Doubt::equal_distances);
  }
  return all;
}

std::string lengths_text(const DistanceTable& table, double confidence, std::optional<double> sigma_mm) {
  const std::vector<Lengths> lengths = lengths_of(table, confidence);
  std::vector<Doubt> doubts;
  int num_runs = 0, num_clogs = 0;
  for (const Lengths& one : lengths) {
    doubts.insert(doubts.end(), one.doubts.begin(), one.doubts.end());
    num_runs += one.clogging.num_runs;
    num_clogs += one.clogging.num_clogs;
  }
  // The number of clogs reveals a table that marks censored droplets instead of clogged droplets.
  return text_table(rows_of(table, lengths, sigma_mm, confidence)) + legend_of(doubts) +
         fmt::format(
             "\nread: of {}, {} clogged (clogged = 1) and {} still moved where last seen (clogged = 0)\n",
             count_text(num_runs, "droplet"), num_clogs, num_runs - num_clogs);
}

std::string lengths_csv(const DistanceTable& table, double confidence, std::optional<double> sigma_mm) {
  return csv_table(rows_of(table, lengths_of(table, confidence), sigma_mm, confidence));
}

std::vector<std::string> names_of_lengths() {
  const DistanceTable one_group{.source = "", .unit = "mm", .labels = {}, .groups = {DistanceGroup()}};
  constexpr double any_confidence = 0.95;
  std::vector<std::string> names = {"survival", "censored_distances"};
  const auto rows = rows_of(one_group, lengths_of(one_group, any_confidence), 1, any_confidence);
  for (const Field& field : rows.front()) names.push_back(field.name);
  names.insert(names.end(), {"lambda", "note"});  // columns of the printed table
  return names;
}

std::string lengths_json(const DistanceTable& table, double confidence, std::optional<double> sigma_mm) {
  const std::vector<std::vector<Field>> rows =
      rows_of(table, lengths_of(table, confidence), sigma_mm, confidence);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < rows.size(); ++i)
    list.push_back(entry_of(rows[i], table.groups[i].runs, confidence));
  const console::BuildInfo build = console::build_info();
  return console::json_text({{"version", build.version},
                             {"git_describe", build.git_describe},
                             {"confidence", confidence},
                             {"source", table.source},
                             {"unit", table.unit},
                             {"from_distance", table.from},
                             {"labels", table.labels},
                             {"groups", list}});
}

}  // namespace clog::results

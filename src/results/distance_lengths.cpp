#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "clog/console/build_info.hpp"
#include "clog/console/json_text.hpp"
#include "clog/console/rounded.hpp"
#include "clog/console/table.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/fit/survival.hpp"
#include "clog/results/distance_table.hpp"
#include "clog/results/groups.hpp"
#include "clog/sweep/value_list.hpp"
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
  std::vector<Lengths> all;
  std::vector<fit::WeibullTest> tests;
  for (const DistanceGroup& group : table.groups) {
    Lengths& one = all.emplace_back();
    one.clogging = fit::fit_clogging_length(group.runs, confidence);
    one.least_squares = fit::least_squares_length(group.runs);
    one.weibull = fit::test_exponentiality(group.runs);
    if (one.clogging.num_clogs < enough_clogs) one.doubts.push_back(Doubt::few_clogs);
    tests.push_back(one.weibull);
  }
  const std::vector<bool> are_not = fit::are_not_exponential(tests);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (are_not[i]) all[i].doubts.push_back(Doubt::not_exponential);
  return all;
}

/// A unit of lengths: the suffix of names, and the factor from the table's unit.
struct Unit {
  const char *suffix, *text;
  double factor;
};

/// The table's own unit comes first.
std::vector<Unit> units_of(const DistanceTable& table, std::optional<double> sigma_mm) {
  const bool is_in_mm = table.unit == "mm";
  std::vector<Unit> units = {is_in_mm ? Unit{"_mm", "mm", 1} : Unit{"", "sigma", 1}};
  if (sigma_mm) units.push_back(is_in_mm ? Unit{"", "sigma", 1 / *sigma_mm} : Unit{"_mm", "mm", *sigma_mm});
  return units;
}

std::vector<Field> fields_of(const DistanceTable& table, std::size_t group, const Lengths& lengths,
                             const std::vector<Unit>& units) {
  const fit::CloggingLength& clogging = lengths.clogging;
  std::vector<Field> fields;
  for (std::size_t i = 0; i < table.labels.size(); ++i)
    fields.emplace_back(table.labels[i], table.groups[group].labels[i]);
  fields.emplace_back("runs", std::int64_t{clogging.num_runs});
  fields.emplace_back("clogs", std::int64_t{clogging.num_clogs});
  for (const Unit& unit : units)
    for (const auto& [name, length] : {std::pair{"total_distance", clogging.total_distance},
                                       {"clogging_length", clogging.length},
                                       {"clogging_length_lower", clogging.interval.lower},
                                       {"clogging_length_upper", clogging.interval.upper},
                                       {"clogging_length_profile_lower", clogging.profile.lower},
                                       {"clogging_length_profile_upper", clogging.profile.upper},
                                       {"clogging_length_least_squares", lengths.least_squares}})
      fields.emplace_back(std::string(name) + unit.suffix, finite_value(unit.factor * length));
  fields.emplace_back("weibull_shape", finite_value(lengths.weibull.shape));
  fields.emplace_back("weibull_p_value", finite_value(lengths.weibull.p_value));
  std::vector<std::string> words;
  for (const Doubt doubt : lengths.doubts) words.emplace_back(text_of(doubt).word);
  fields.emplace_back("doubts", joined(words, " "));
  return fields;
}

std::vector<std::string> length_cells(const fit::CloggingLength& clogging, const Unit& unit) {
  const double lower = unit.factor * clogging.interval.lower, upper = unit.factor * clogging.interval.upper;
  if (clogging.num_clogs == 0) return {"> " + console::plain(lower), "-"};
  const auto rounded = console::with_interval(unit.factor * clogging.length, lower, upper);
  return {rounded.value, rounded.lower + " .. " + rounded.upper};
}

}  // namespace

std::string lengths_text(const DistanceTable& table, double confidence, std::optional<double> sigma_mm) {
  const std::vector<Unit> units = units_of(table, sigma_mm);
  const std::vector<Lengths> lengths = lengths_of(table, confidence);
  std::vector<std::vector<std::string>> lines = {table.labels};
  lines[0].insert(lines[0].end(), {"runs", "clogs"});
  for (const Unit& unit : units)
    lines[0].insert(lines[0].end(),
                    {fmt::format("lambda/{}", unit.text), fmt::format("{:g} %", 100 * confidence)});
  lines[0].emplace_back("note");
  std::string legend;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    std::vector<std::string>& line = lines.emplace_back();
    for (const Value& label : table.groups[i].labels) line.push_back(short_text(label));
    line.push_back(std::to_string(lengths[i].clogging.num_runs));
    line.push_back(std::to_string(lengths[i].clogging.num_clogs));
    for (const Unit& unit : units)
      for (std::string& cell : length_cells(lengths[i].clogging, unit)) line.push_back(std::move(cell));
    std::string letters;
    for (const Doubt doubt : lengths[i].doubts) {
      const DoubtText& text = text_of(doubt);
      letters += text.letter;
      const std::string sentence = fmt::format(
          "{}: {}\n", text.letter,
          doubt == Doubt::few_clogs ? "fewer than 5 clogs: more droplets are needed" : text.sentence);
      if (legend.find(sentence) == std::string::npos) legend += sentence;
    }
    line.push_back(std::move(letters));
  }
  int num_runs = 0, num_clogs = 0;
  for (const Lengths& one : lengths) {
    num_runs += one.clogging.num_runs;
    num_clogs += one.clogging.num_clogs;
  }
  // If a table marks censored droplets instead of clogged ones, these numbers show it.
  return console::aligned(lines) + "\n" + legend +
         fmt::format(
             "read: of {}, {} clogged (clogged = 1) and {} still moved where last seen (clogged = 0)\n",
             sweep::counted(num_runs, "droplet"), num_clogs, num_runs - num_clogs);
}

std::string lengths_csv(const DistanceTable& table, double confidence, std::optional<double> sigma_mm) {
  const std::vector<Unit> units = units_of(table, sigma_mm);
  const std::vector<Lengths> lengths = lengths_of(table, confidence);
  std::vector<std::vector<Field>> rows;
  rows.reserve(lengths.size());
  for (std::size_t i = 0; i < lengths.size(); ++i) rows.push_back(fields_of(table, i, lengths[i], units));
  return csv_table(rows);
}

std::string lengths_json(const DistanceTable& table, double confidence, std::optional<double> sigma_mm) {
  const std::vector<Unit> units = units_of(table, sigma_mm);
  const std::vector<Lengths> lengths = lengths_of(table, confidence);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    nlohmann::ordered_json entry;
    for (const auto& [name, value] : fields_of(table, i, lengths[i], units)) entry[name] = json_of(value);
    entry["survival"] = entry["censored_distances"] = nlohmann::ordered_json::array();
    const std::vector<fit::Observation>& runs = table.groups[i].runs;
    for (const fit::SurvivalStep& step : fit::survival_curve(runs, confidence))
      entry["survival"].push_back(step_json(step, "clogs", step.num_clogs));
    std::vector<double> censored;
    for (const fit::Observation& run : runs)
      if (!run.clogged) censored.push_back(run.distance);
    std::ranges::sort(censored);
    entry["censored_distances"] = censored;
    list.push_back(std::move(entry));
  }
  const console::BuildInfo build = console::build_info();
  return console::json_text({{"version", build.version},
                             {"git_describe", build.git_describe},
                             {"confidence", confidence},
                             {"source", table.source},
                             {"unit", table.unit},
                             {"labels", table.labels},
                             {"groups", list}});
}

}  // namespace clog::results

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "clog/console/build_info.hpp"
#include "clog/console/json_text.hpp"
#include "clog/console/rounded.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/results/comparison.hpp"
#include "clog/sweep/columns.hpp"
#include "value_json.hpp"

namespace clog::results {
namespace {

std::string bounded_length(const fit::CloggingLength& length, double factor) {
  const double lower = factor * length.interval.lower, upper = factor * length.interval.upper;
  return length.num_clogs == 0 ? "> " + console::plain(lower)
                               : console::with_interval(factor * length.length, lower, upper).value;
}

/// @param clogs_head, length_head  heads of the printed columns
void append_length(const std::string& side, const fit::CloggingLength& length, const Comparisons& all,
                   const Flaws& flaws, const char* clogs_head, const std::string& length_head,
                   std::vector<Field>& fields) {
  fields.push_back({"runs_" + side, std::int64_t{length.num_runs}});
  fields.push_back({"clogs_" + side, std::int64_t{length.num_clogs}, "", clogs_head});
  fields.push_back({"failed_" + side, std::int64_t{flaws.num_failed}});
  fields.push_back({"doubts_" + side, words_of(flaws.doubts)});
  const auto append = [&](const std::string& unit, double factor, const std::string& head) {
    const std::string name = "clogging_length_" + side;
    fields.push_back(
        {name + unit, finite_value(factor * length.length), "", head, bounded_length(length, factor)});
    fields.push_back({name + "_lower" + unit, finite_value(factor * length.interval.lower)});
    fields.push_back({name + "_upper" + unit, finite_value(factor * length.interval.upper)});
  };
  append(all.unit == "mm" ? "_mm" : "", 1, all.sigma_mm ? "" : length_head);
  if (all.sigma_mm) append("_mm", *all.sigma_mm, length_head);
}

bool have_pairs(const Comparisons& all) {
  return std::ranges::any_of(all.all, [](const Comparison& one) { return one.ratio.num_pairs > 0; });
}

std::vector<Field> fields_of(const Comparison& one, const Comparisons& all) {
  std::vector<Field> fields = {{"here", one.here, "", "of", one.here}, {"there", one.there}};
  for (std::size_t i = 0; i < all.columns.size(); ++i)
    fields.push_back({all.columns[i], one.common[i], "", all.columns[i]});
  const std::string unit = all.sigma_mm ? "mm" : all.unit;
  append_length("here", one.length_here, all, one.flaws_here, "clogs", "lambda/" + unit, fields);
  append_length("there", one.length_there, all, one.flaws_there, "clogs there", "lambda there", fields);
  const fit::LengthRatio& ratio = one.ratio;
  const bool is_paired = have_pairs(all), is_known = !std::isnan(ratio.interval.lower);
  const auto shown = console::with_interval(ratio.ratio, ratio.interval.lower, ratio.interval.upper);
  const std::string interval = one.are_identical ? "identical" : shown.lower + " .. " + shown.upper;
  const auto bound = [&](double value) { return one.are_identical ? Value() : finite_value(value); };
  fields.insert(fields.end(),
                {{"ratio", finite_value(ratio.ratio), "", "ratio",
                  !is_known           ? "-"
                  : one.are_identical ? "1"
                                      : shown.value},
                 {"ratio_lower", bound(ratio.interval.lower), "",
                  fmt::format("{:.4g} %", 100 * all.confidence), is_known ? interval : "-"},
                 {"ratio_upper", bound(ratio.interval.upper)},
                 {"interval",
                  one.are_identical ? "identical"
                  : ratio.is_paired ? "paired"
                                    : "unpaired",
                  "", is_paired ? "paired" : "", ratio.is_paired ? "yes" : "no"},
                 {"unpaired_lower", bound(ratio.unpaired.lower)},
                 {"unpaired_upper", bound(ratio.unpaired.upper)},
                 {"pairs", std::int64_t{ratio.num_pairs}},
                 {"unlike_pairs", std::int64_t{ratio.num_unlike}},
                 {"paired_ratio", finite_value(ratio.paired_ratio)},
                 {"paired_lower", finite_value(ratio.paired.lower)},
                 {"paired_upper", finite_value(ratio.paired.upper)},
                 {"correlation", finite_value(ratio.correlation)},
                 {"gain", finite_value(ratio.gain), "", is_paired ? "gain" : "",
                  std::isnan(ratio.gain) ? "-" : fmt::format("{:.2f}", ratio.gain)},
                 {"log_rank_p", finite_value(one.log_rank_p)},
                 {"log_rank_p_holm", finite_value(one.log_rank_p_holm), "", is_paired ? "" : "log-rank p",
                  std::isnan(one.log_rank_p) ? "-" : fmt::format("{:.2g}", one.log_rank_p_holm)},
                 {"both_clogged", std::int64_t{one.num_both_clogged}},
                 {"same_place", std::int64_t{one.num_same_place}, "", is_paired ? "same place" : "",
                  fmt::format("{} of {}", one.num_same_place, one.num_both_clogged)}});
  return fields;
}

std::vector<std::vector<Field>> rows_of(const Comparisons& comparisons) {
  std::vector<std::vector<Field>> rows;
  for (const Comparison& one : comparisons.all) rows.push_back(fields_of(one, comparisons));
  return rows;
}

/// The letters of the doubts here and there, as `fx/c`.
std::string note_of(const Comparison& one) {
  const auto text = [](const Flaws& flaws) { return flaws.doubts.empty() ? "-" : letters_of(flaws.doubts); };
  return text(one.flaws_here) + '/' + text(one.flaws_there);
}

/// All doubts, and the number of failed runs. A reference group that occurs in several comparisons counts
/// only once.
Flaws all_flaws(const Comparisons& comparisons) {
  Flaws all;
  std::map<std::vector<Value>, int> failed;
  const auto add = [&](std::vector<Value> side, const std::string& name, const Flaws& flaws) {
    side.emplace_back(name);
    failed[side] = flaws.num_failed;
    all.doubts.insert(all.doubts.end(), flaws.doubts.begin(), flaws.doubts.end());
  };
  for (const Comparison& one : comparisons.all) {
    add(one.common, one.here, one.flaws_here);
    add(one.common, one.there, one.flaws_there);
  }
  for (const auto& [side, number] : failed) all.num_failed += number;
  return all;
}

}  // namespace

std::string to_text(const Comparisons& comparisons) {
  std::string text = fmt::format("lambda of each over that of {}", comparisons.all.front().there);
  if (!comparisons.differing.empty()) text += "; they differ in " + joined(comparisons.differing);
  std::vector<std::vector<Field>> rows = rows_of(comparisons);
  const Flaws flaws = all_flaws(comparisons);
  if (!flaws.doubts.empty())
    for (std::size_t i = 0; i < rows.size(); ++i)
      rows[i].push_back({"", Value(), "", "note", note_of(comparisons.all[i])});
  text += "\n\n" + text_table(rows) + legend_of(flaws.doubts);
  if (flaws.num_failed > 0)
    text += fmt::format("   {} failed, and count{} as not clogged up to sound_distance\n",
                        count_text(flaws.num_failed, "run"), flaws.num_failed == 1 ? "s" : "");
  if (std::ranges::any_of(comparisons.all, &Comparison::are_identical))
    text += "\nidentical: all runs end at the same places here and there, as copies of the same runs do\n";
  if (!have_pairs(comparisons)) {
    text += "\nno runs have the same seed, so intervals are those of independent runs\n";
    text += "log-rank p: probability that curves P(r) of one law differ as much";
    const std::ptrdiff_t number = comparisons.num_tests;
    return text + (number > 1 ? fmt::format(", corrected for {} comparisons (Holm)\n", number) : "\n");
  }
  text +=
      "\npaired: the interval is from pairs of the same seed; gain: how many times smaller the error of "
      "the ratio is with\npairs than without; same place: pairs that clogged within ";
  text +=
      comparisons.within > 0 ? fmt::format("{:.4g} sigma", comparisons.within) : "half an obstacle spacing";
  return text + " of each other, of those in which both clogged\n";
}

std::string to_csv(const Comparisons& comparisons) { return csv_table(rows_of(comparisons)); }

std::vector<std::string> names_of_comparisons() {
  Comparisons in_both_units;
  in_both_units.sigma_mm = 1;
  std::vector<std::string> names;
  for (const Field& field : fields_of(Comparison(), in_both_units)) names.push_back(field.name);
  return names;
}

std::string to_json(const Comparisons& comparisons) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const std::vector<Field>& row : rows_of(comparisons)) list.push_back(json_of(row));
  const console::BuildInfo build = console::build_info();
  const nlohmann::ordered_json document = {
      {"version", build.version},
      {"git_describe", build.git_describe},
      {"confidence", comparisons.confidence},
      {"columns", comparisons.columns},
      {"differing", comparisons.differing},
      {"within",
       comparisons.within > 0 ? nlohmann::ordered_json(comparisons.within) : nlohmann::ordered_json()},
      {"comparisons", list}};
  return console::json_text(document);
}

}  // namespace clog::results

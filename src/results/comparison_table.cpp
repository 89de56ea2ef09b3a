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
#include "clog/console/table.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/results/comparison.hpp"
#include "clog/sweep/columns.hpp"
#include "clog/sweep/value_list.hpp"
#include "value_json.hpp"

namespace clog::results {
namespace {

void append_length(const std::string& side, const fit::CloggingLength& length, const Comparisons& all,
                   const Flaws& flaws, std::vector<Field>& fields) {
  fields.emplace_back("runs_" + side, std::int64_t{length.num_runs});
  fields.emplace_back("clogs_" + side, std::int64_t{length.num_clogs});
  fields.emplace_back("failed_" + side, std::int64_t{flaws.num_failed});
  fields.emplace_back("doubts_" + side, words_of(flaws.doubts));
  const auto append = [&](const std::string& unit, double factor) {
    const std::string name = "clogging_length_" + side;
    fields.emplace_back(name + unit, finite_value(factor * length.length));
    fields.emplace_back(name + "_lower" + unit, finite_value(factor * length.interval.lower));
    fields.emplace_back(name + "_upper" + unit, finite_value(factor * length.interval.upper));
  };
  append(all.unit == "mm" ? "_mm" : "", 1);
  if (all.sigma_mm) append("_mm", *all.sigma_mm);
}

std::vector<Field> fields_of(const Comparison& one, const Comparisons& all) {
  std::vector<Field> fields = {{"here", one.here}, {"there", one.there}};
  for (std::size_t i = 0; i < all.columns.size(); ++i) fields.emplace_back(all.columns[i], one.common[i]);
  append_length("here", one.length_here, all, one.flaws_here, fields);
  append_length("there", one.length_there, all, one.flaws_there, fields);
  const fit::LengthRatio& ratio = one.ratio;
  fields.emplace_back("ratio", finite_value(ratio.ratio));
  const auto bound = [&](double value) { return one.are_identical ? Value() : finite_value(value); };
  fields.emplace_back("ratio_lower", bound(ratio.interval.lower));
  fields.emplace_back("ratio_upper", bound(ratio.interval.upper));
  fields.emplace_back("interval", std::string(one.are_identical ? "identical"
                                              : ratio.is_paired ? "paired"
                                                                : "unpaired"));
  fields.emplace_back("unpaired_lower", bound(ratio.unpaired.lower));
  fields.emplace_back("unpaired_upper", bound(ratio.unpaired.upper));
  fields.emplace_back("pairs", std::int64_t{ratio.num_pairs});
  fields.emplace_back("unlike_pairs", std::int64_t{ratio.num_unlike});
  fields.emplace_back("paired_ratio", finite_value(ratio.paired_ratio));
  fields.emplace_back("paired_lower", finite_value(ratio.paired.lower));
  fields.emplace_back("paired_upper", finite_value(ratio.paired.upper));
  fields.emplace_back("correlation", finite_value(ratio.correlation));
  fields.emplace_back("gain", finite_value(ratio.gain));
  fields.emplace_back("log_rank_p", finite_value(one.log_rank_p));
  fields.emplace_back("log_rank_p_holm", finite_value(one.log_rank_p_holm));
  fields.emplace_back("both_clogged", std::int64_t{one.num_both_clogged});
  fields.emplace_back("same_place", std::int64_t{one.num_same_place});
  return fields;
}

std::string bounded_length(const fit::CloggingLength& length, double factor) {
  const double lower = factor * length.interval.lower, upper = factor * length.interval.upper;
  return length.num_clogs == 0 ? "> " + console::plain(lower)
                               : console::with_interval(factor * length.length, lower, upper).value;
}

/// The letters of the doubts here and there, as `fx/c`.
std::string note_of(const Comparison& one) {
  const auto text = [](const Flaws& flaws) { return flaws.doubts.empty() ? "-" : letters_of(flaws.doubts); };
  return text(one.flaws_here) + '/' + text(one.flaws_there);
}

/// All doubts, and the number of failed runs. A reference that is compared several times counts once.
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

/// @param factor  the unit of the lengths divided by the unit shown
std::vector<std::string> cells(const Comparison& one, double factor, bool have_pairs) {
  const fit::LengthRatio& ratio = one.ratio;
  std::vector<std::string> all = {
      std::to_string(one.length_here.num_clogs), bounded_length(one.length_here, factor),
      std::to_string(one.length_there.num_clogs), bounded_length(one.length_there, factor)};
  if (std::isnan(ratio.interval.lower)) {
    all.insert(all.end(), {"-", "-"});
  } else {
    const auto rounded = console::with_interval(ratio.ratio, ratio.interval.lower, ratio.interval.upper);
    all.insert(all.end(), {one.are_identical ? "1" : rounded.value,
                           one.are_identical ? "identical" : rounded.lower + " .. " + rounded.upper});
  }
  if (!have_pairs) {
    all.push_back(std::isnan(one.log_rank_p) ? "-" : fmt::format("{:.2g}", one.log_rank_p_holm));
    return all;
  }
  all.emplace_back(ratio.is_paired ? "yes" : "no");
  all.push_back(std::isnan(ratio.gain) ? "-" : fmt::format("{:.2f}", ratio.gain));
  all.push_back(fmt::format("{} of {}", one.num_same_place, one.num_both_clogged));
  return all;
}

}  // namespace

std::string to_text(const Comparisons& comparisons, double confidence) {
  std::string text = fmt::format("lambda of each over that of {}", comparisons.all.front().there);
  if (!comparisons.differing.empty()) text += "; they differ in " + joined(comparisons.differing);
  std::vector<std::vector<std::string>> lines = {{"of"}};
  lines[0].insert(lines[0].end(), comparisons.columns.begin(), comparisons.columns.end());
  const std::string unit = comparisons.sigma_mm ? "mm" : comparisons.unit;
  const bool have_pairs =
      std::ranges::any_of(comparisons.all, [](const Comparison& one) { return one.ratio.num_pairs > 0; });
  lines[0].insert(lines[0].end(), {"clogs", "lambda/" + unit, "clogs there", "lambda there", "ratio",
                                   fmt::format("{:.4g} %", 100 * confidence)});
  if (have_pairs) {
    lines[0].insert(lines[0].end(), {"paired", "gain", "same place"});
  } else {
    lines[0].emplace_back("log-rank p");
  }
  const Flaws flaws = all_flaws(comparisons);
  if (!flaws.doubts.empty()) lines[0].emplace_back("note");
  const auto labels = label_texts(comparisons.all, &Comparison::common);
  for (std::size_t i = 0; i < comparisons.all.size(); ++i) {
    const Comparison& one = comparisons.all[i];
    std::vector<std::string>& line = lines.emplace_back(1, one.here);
    line.insert(line.end(), labels[i].begin(), labels[i].end());
    for (std::string& cell : cells(one, comparisons.sigma_mm.value_or(1), have_pairs))
      line.push_back(std::move(cell));
    if (!flaws.doubts.empty()) line.push_back(note_of(one));
  }
  text += "\n\n" + console::aligned(lines) + legend_of(flaws.doubts);
  if (flaws.num_failed > 0)
    text += fmt::format("   {} failed, and count{} as not clogged up to sound_distance\n",
                        sweep::counted(flaws.num_failed, "run"), flaws.num_failed == 1 ? "s" : "");
  if (std::ranges::any_of(comparisons.all, &Comparison::are_identical))
    text += "\nidentical: all runs end at the same places here and there, as copies of the same runs do\n";
  if (!have_pairs) {
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

std::string to_csv(const Comparisons& comparisons) {
  std::vector<std::vector<Field>> rows;
  rows.reserve(comparisons.all.size());
  for (const Comparison& one : comparisons.all) rows.push_back(fields_of(one, comparisons));
  return csv_table(rows);
}

std::vector<std::string> names_of_comparisons() {
  Comparisons in_both_units;
  in_both_units.sigma_mm = 1;
  std::vector<std::string> names;
  for (const auto& [name, value] : fields_of(Comparison(), in_both_units)) names.push_back(name);
  return names;
}

std::string to_json(const Comparisons& comparisons, double confidence) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Comparison& one : comparisons.all) {
    nlohmann::ordered_json entry;
    for (const auto& [name, value] : fields_of(one, comparisons)) entry[name] = json_of(value);
    list.push_back(std::move(entry));
  }
  const console::BuildInfo build = console::build_info();
  const nlohmann::ordered_json document = {
      {"version", build.version},
      {"git_describe", build.git_describe},
      {"confidence", confidence},
      {"columns", comparisons.columns},
      {"differing", comparisons.differing},
      {"within",
       comparisons.within > 0 ? nlohmann::ordered_json(comparisons.within) : nlohmann::ordered_json()},
      {"comparisons", list}};
  return console::json_text(document);
}

}  // namespace clog::results

#include "clog/campaign/curve_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <variant>

#include "clog/console/build_info.hpp"
#include "clog/console/json_text.hpp"
#include "clog/console/rounded.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/sweep/value_list.hpp"
#include "value_json.hpp"

namespace clog::campaign {
namespace {

using nlohmann::ordered_json;

double value_at(const fit::CurvePlace& place, std::size_t key) {
  return std::exp(place[static_cast<Eigen::Index>(key)]);
}

/// `0.51 (0.44 to 0.6)`.
std::string value_and_interval(double value, double lower, double upper) {
  if (!std::isfinite(lower) || !std::isfinite(upper)) return fmt::format("{:.3g}", value);
  const console::RoundedInterval rounded = console::with_interval(value, lower, upper);
  return fmt::format("{} ({} to {})", rounded.value, rounded.lower, rounded.upper);
}

std::string shared_text(const FittedCurve& curve) {
  std::vector<std::string> words;
  for (const auto& [name, value] : curve.shared)
    words.push_back(fmt::format("{}={}", name, short_text(value)));
  return joined(words, " ");
}

std::string peak_text(const FittedCurve& curve, const CurveQuestion& question) {
  const fit::CurvePeak& peak = curve.peak;
  std::vector<std::string> at;
  for (std::size_t key = 0; key < question.keys.size(); ++key)
    at.push_back(fmt::format("{} {}", question.keys[key]->name,
                             value_and_interval(value_at(peak.place, key), value_at(peak.place_lower, key),
                                                value_at(peak.place_upper, key))));
  std::string text = fmt::format("highest at {}, with lambda {} sigma\n", joined(at, ", "),
                                 value_and_interval(peak.length, peak.interval.lower, peak.interval.upper));
  if (1 - peak.share_inside > 1 - question.confidence)
    text += fmt::format("  (with a probability of {:.0f} % it is higher at a border than anywhere between)\n",
                        100 * (1 - peak.share_inside));
  return text;
}

std::string crossings_text(const FittedCurve& curve, const CurveQuestion& question) {
  std::string text;
  for (std::size_t i = 0; i < question.crossed_lengths.size(); ++i) {
    const std::string length = shortest(question.crossed_lengths[i]);
    if (curve.crossings[i].empty())
      text += fmt::format("does not cross {} sigma between these values\n", length);
    for (const fit::CurveCrossing& one : curve.crossings[i]) {
      const bool is_open = std::isinf(one.interval.lower) || std::isinf(one.interval.upper);
      text += fmt::format(
          "crosses {} sigma {} at {} {}{}\n", length, one.is_upward ? "upwards" : "downwards",
          question.keys[0]->name,
          value_and_interval(std::exp(one.place), std::exp(one.interval.lower), std::exp(one.interval.upper)),
          is_open ? ", or beyond the outermost values" : "");
    }
  }
  return text;
}

/// Every eighth place of a line, every sixth of a surface's sides.
std::string values_text(const FittedCurve& curve, const CurveQuestion& question) {
  constexpr std::size_t step_on_line = 8;
  constexpr std::size_t num_on_side = 25;
  constexpr std::size_t step_on_side = 6;
  const bool is_line = question.keys.size() == 1;
  std::string text;
  for (const sweep::Column* key : question.keys) text += fmt::format("{:>{}}  ", key->name, 10);
  text += fmt::format("{:>12}  {:>10}  {:>10}\n", "lambda/sigma", "lower", "upper");
  for (std::size_t i = 0; i < curve.places.size(); ++i) {
    const bool is_shown = is_line
                              ? i % step_on_line == 0
                              : i % num_on_side % step_on_side == 0 && i / num_on_side % step_on_side == 0;
    if (!is_shown) continue;
    for (std::size_t key = 0; key < question.keys.size(); ++key)
      text += fmt::format("{:>{}.4g}  ", value_at(curve.places[i], key),
                          std::max<std::size_t>(question.keys[key]->name.size(), 10));
    const fit::CurveValue& value = curve.values[i];
    text +=
        fmt::format("{:>12.3g}  {:>10.3g}  {:>10.3g}\n", value.length, value.band.lower, value.band.upper);
  }
  return text;
}

ordered_json number(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

/// The keys' values at a place, by the names of their columns.
ordered_json place_json(const fit::CurvePlace& place, const CurveQuestion& question) {
  ordered_json entry;
  for (std::size_t key = 0; key < question.keys.size(); ++key)
    entry[question.keys[key]->name] = value_at(place, key);
  return entry;
}

void add_length(ordered_json& entry, double length, const fit::Interval& interval,
                const std::string& name = "clogging_length",
                const std::string& lower = "clogging_length_lower",
                const std::string& upper = "clogging_length_upper") {
  entry[name] = number(length);
  entry[lower] = number(interval.lower);
  entry[upper] = number(interval.upper);
}

ordered_json peak_json(const FittedCurve& curve, const CurveQuestion& question) {
  ordered_json peak = place_json(curve.peak.place, question);
  for (std::size_t key = 0; key < question.keys.size(); ++key) {
    peak[question.keys[key]->name + "_lower"] = value_at(curve.peak.place_lower, key);
    peak[question.keys[key]->name + "_upper"] = value_at(curve.peak.place_upper, key);
  }
  add_length(peak, curve.peak.length, curve.peak.interval);
  peak["probability_between_borders"] = curve.peak.share_inside;
  return peak;
}

ordered_json crossings_json(const FittedCurve& curve, const CurveQuestion& question) {
  ordered_json all = ordered_json::array();
  for (std::size_t i = 0; i < question.crossed_lengths.size(); ++i)
    for (const fit::CurveCrossing& one : curve.crossings[i])
      all.push_back({{"clogging_length", question.crossed_lengths[i]},
                     {question.keys[0]->name, std::exp(one.place)},
                     {question.keys[0]->name + "_lower", number(std::exp(one.interval.lower))},
                     {question.keys[0]->name + "_upper", number(std::exp(one.interval.upper))},
                     {"direction", one.is_upward ? "upwards" : "downwards"}});
  return all;
}

ordered_json curve_json(const FittedCurve& curve, std::span<const Group> groups,
                        const CurveQuestion& question) {
  ordered_json entry;
  entry["shared"] = ordered_json::object();
  for (const auto& [name, value] : curve.shared) entry["shared"][name] = json_of(value);
  entry["points"] = ordered_json::array();
  for (const std::size_t index : curve.groups) {
    const Group& group = groups[index];
    ordered_json point = {{"group", index}};
    point.update(place_json(curve_place(group, question.keys), question));
    point["runs"] = group.clogging.num_runs;
    point["clogs"] = group.clogging.num_clogs;
    point["total_distance"] = group.clogging.total_distance;
    add_length(point, group.clogging.length, group.clogging.interval);
    entry["points"].push_back(std::move(point));
  }
  entry["curve"] = ordered_json::array();
  for (std::size_t i = 0; i < curve.places.size(); ++i) {
    ordered_json place = place_json(curve.places[i], question);
    add_length(place, curve.values[i].length, curve.values[i].band);
    for (const CurveByCause& cause : curve.causes)
      add_length(place, cause.values[i].length, cause.values[i].band, cause.text->length, cause.text->lower,
                 cause.text->upper);
    entry["curve"].push_back(std::move(place));
  }
  entry["common_obstacles"] = curve.has_common_obstacles;
  entry["peak"] = peak_json(curve, question);
  entry["crossings"] = crossings_json(curve, question);
  return entry;
}

}  // namespace

std::string curves_to_text(const std::vector<FittedCurve>& curves, std::span<const Group> groups,
                           const CurveQuestion& question) {
  std::vector<std::string> names;
  for (const sweep::Column* key : question.keys) names.push_back(key->name);
  std::string text = fmt::format("lambda vs {}, fitted; {} % intervals\n", joined(names, " and "),
                                 shortest(100 * question.confidence));
  for (const FittedCurve& curve : curves) {
    std::int64_t num_clogs = 0;
    for (const std::size_t index : curve.groups) num_clogs += groups[index].clogging.num_clogs;
    const std::string shared = shared_text(curve);
    text += fmt::format("\n{}{}through {} with {}\n", shared, shared.empty() ? "" : ": ",
                        sweep::counted(static_cast<std::int64_t>(curve.groups.size()), "point"),
                        sweep::counted(num_clogs, "clog"));
    if (curve.has_common_obstacles)
      text +=
          "  (points share seeds and so obstacles: their errors are correlated, the band takes them for "
          "independent)\n";
    text +=
        peak_text(curve, question) + crossings_text(curve, question) + '\n' + values_text(curve, question);
  }
  return text;
}

std::string curves_to_csv(const std::vector<FittedCurve>& curves, const CurveQuestion& question) {
  std::string table;
  for (const Field& field : curves.front().shared) table += fmt::format("{},", field.first);
  for (const sweep::Column* key : question.keys) table += key->name + ',';
  table += "clogging_length,clogging_length_lower,clogging_length_upper";
  for (const CauseText& text : cause_texts)
    table += fmt::format(",{},{},{}", text.length, text.lower, text.upper);
  table += '\n';
  for (const FittedCurve& curve : curves)
    for (std::size_t i = 0; i < curve.places.size(); ++i) {
      for (const Field& field : curve.shared) table += csv_cell(field.second) + ',';
      for (std::size_t key = 0; key < question.keys.size(); ++key)
        table += shortest(value_at(curve.places[i], key)) + ',';
      const fit::CurveValue& value = curve.values[i];
      table += fmt::format("{},{},{}", value.length, value.band.lower, value.band.upper);
      for (const CauseText& text : cause_texts) {
        const auto cause =
            std::ranges::find(curve.causes, &text, [](const CurveByCause& one) { return one.text; });
        table += cause == curve.causes.end()
                     ? ",,,"
                     : fmt::format(",{},{},{}", cause->values[i].length, cause->values[i].band.lower,
                                   cause->values[i].band.upper);
      }
      table += '\n';
    }
  return table;
}

std::string curves_to_json(const std::vector<FittedCurve>& curves, std::span<const Group> groups,
                           const CurveQuestion& question) {
  ordered_json list = ordered_json::array();
  for (const FittedCurve& curve : curves) list.push_back(curve_json(curve, groups, question));
  ordered_json units = {{"clogging_length", "sigma"}, {"total_distance", "sigma"}};
  ordered_json keys = ordered_json::array();
  for (const sweep::Column* key : question.keys) {
    keys.push_back(key->name);
    if (!key->unit.empty()) units[key->name] = key->unit;
  }
  const console::BuildInfo build = console::build_info();
  const ordered_json document = {{"version", build.version},
                                 {"git_describe", build.git_describe},
                                 {"confidence", question.confidence},
                                 {"keys", keys},
                                 {"units", units},
                                 {"curves", list}};
  return console::json_text(document);
}

}  // namespace clog::campaign

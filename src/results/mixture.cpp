#include "clog/results/mixture.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string_view>
#include <utility>

#include "clog/console/csv.hpp"
#include "clog/console/rounded.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/core/tools/split.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/fit/percentiles.hpp"
#include "clog/results/selection.hpp"
#include "clog/results/usual_parameters.hpp"
#include "clog/sweep/value_list.hpp"
#include "result_columns.hpp"

namespace clog::results {
namespace {

constexpr int num_resamples = 2000;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// A run, with its distance in the unit of the mixture.
struct Run {
  double distance;
  bool is_clog;
  std::size_t seed;  // place of the run's seed among the seeds of the mixture
};
struct Size {
  double share;
  std::vector<Run> runs;  // sorted by distance; at equal distances clogs come first
};

[[noreturn]] void refuse(const std::string& text, const std::string& why, const std::string& remedy) {
  throw Error(fmt::format("invalid --mixture={} ({}) {}", text, why, remedy));
}

/// @param word  a part of the option's text
double number_in(std::string_view word, const std::string& text) try {
  return sweep::to_number(word);
} catch (const Error& error) {
  refuse(text, error.what(), "use e.g. diameter=2.8mm:0.3,3.2mm:0.7");
}

/// A text for a value. Equal values have equal texts; an unset value has an empty text.
std::string name_of(const Value& value) {
  const auto* const number = std::get_if<double>(&value);
  return number ? shortest(twelve_digits(*number)) : sweep::text_of(value);
}
std::string name_of_diameter(double in_mm) {
  return std::isfinite(in_mm) ? shortest(twelve_digits(in_mm)) + " mm" : "";
}

/// Distinguishes groups by the diameter of their droplets, or by a column.
class Key {
 public:
  Key(const std::string& name, const std::string& text) : name_(name), text_(text) {
    std::ranges::replace(name_, '-', '_');
    if (name_ == "diameter") return;
    std::vector<std::string> names;
    for (const sweep::Column* column : group_columns()) {
      names.push_back(column->name);
      if (column->name == name_) column_ = column;
    }
    if (!column_)
      refuse(text, fmt::format("'{}' is no parameter of a run", name),
             "give diameter or a parameter" + hint_at_column(name, did_you_mean(name_, names)));
  }

  const std::string& name() const { return name_; }
  std::string of(const Group& group) const {
    if (column_) return name_of(column_->get(group.first_row));
    return name_of_diameter(group.laboratory.value_or(LaboratoryScale()).length);
  }
  /// The corresponding text for a value that the user typed.
  std::string of(const std::string& value) const {
    if (column_)
      return column_->kind == ValueKind::word ? value : shortest(twelve_digits(number_in(value, text_)));
    const auto end_of_number = std::min(value.find_first_not_of("0123456789.+-eE"), value.size());
    const auto metres = console::metres_of(console::trimmed(value.substr(end_of_number)));
    if (!metres)
      refuse(text_, fmt::format("the diameter '{}' has no unit of length", value), "use e.g. 2.8mm");
    return name_of_diameter(number_in(value.substr(0, end_of_number), text_) * *metres / 1e-3);
  }

 private:
  std::string name_, text_;
  const sweep::Column* column_ = nullptr;
};

/// The parameters in which groups differ, except automatic parameters. A parameter that applies only to some
/// of the groups counts only if it differs between these groups.
std::string differences(const std::vector<const Group*>& groups) {
  std::vector<std::string> names;
  for (const sweep::Column* column : group_columns()) {
    std::set<Value> values;
    for (const Group* group : groups)
      if (column->applies_to(group->first_row.parameters))
        values.insert(separating_value(*column, group->first_row));
    if (values.size() > 1) names.push_back(column->name);
  }
  return names.empty() ? "automatic values" : joined(names);
}

const Group& find_group(const Key& key, const std::string& value, const std::vector<Group>& groups,
                        const std::string& text) {
  std::vector<const Group*> found;
  std::set<std::string> known;
  bool is_without_length = false;
  for (const Group& group : groups) {
    const std::string name = key.of(group);
    if (!has_clogging_length(group.first_row)) {
      is_without_length = is_without_length || name == value;
      continue;
    }
    if (name == value) found.push_back(&group);
    if (!name.empty()) known.insert(name);
  }
  if (found.empty() && is_without_length)
    refuse(
        text,
        fmt::format("droplets with {} = {} are in a channel or on a wall, where they have no clogging length",
                    key.name(), value),
        "mix droplets in arrays");
  if (found.empty())
    refuse(text, fmt::format("no group has {} = {}", key.name(), value),
           known.empty() ? "the runs have no laboratory" : "the groups have " + joined(known));
  if (found.size() > 1)
    refuse(text,
           fmt::format("{} groups have {} = {} and differ in {}", found.size(), key.name(), value,
                       differences(found)),
           "choose one of them with clogsweep select");
  if (found.front()->clogging.num_runs == 0)
    refuse(text, fmt::format("no run with {} = {} counts", key.name(), value), "leave it out");
  return *found.front();
}

/// Reads the names of the values and their shares.
std::vector<Mixture::Part> parts_of(const std::string& list, const Key& key, const std::string& text) {
  std::vector<Mixture::Part> parts;
  double sum = 0;
  for (const std::string& word : split_at_commas(list)) {
    const auto colon = word.rfind(':');
    if (colon == std::string::npos)
      refuse(text, fmt::format("'{}' is not VALUE:WEIGHT", word), "use e.g. diameter=2.8mm:0.3,3.2mm:0.7");
    parts.push_back({key.of(console::trimmed(word.substr(0, colon))),
                     number_in(console::trimmed(word.substr(colon + 1)), text)});
    if (parts.back().share < 0) refuse(text, "a weight is negative", "use weights of 0 or more");
    sum += parts.back().share;
    if (std::ranges::count(parts, parts.back().value, &Mixture::Part::value) > 1)
      refuse(text, parts.back().value + " occurs twice", "give each value one weight");
  }
  if (parts.size() < 2) refuse(text, "a single value is no mixture", "give two values or more");
  if (sum == 0) refuse(text, "all weights are 0", "give a weight above 0");
  if (std::isinf(sum)) refuse(text, "the sum of the weights is infinite", "give smaller weights");
  for (Mixture::Part& part : parts) part.share /= sum;
  return parts;
}

struct Estimate {
  double length;
  std::vector<double> probabilities;
};

/// @param times  how often each seed counts; @param places  distances at which P(r) is estimated, ascending
Estimate estimate(const std::vector<Size>& sizes, const std::vector<int>& times,
                  const std::vector<double>& places) {
  Estimate all{0, std::vector<double>(places.size())};
  double clogs_per_run = 0, way_per_run = 0;
  for (const Size& size : sizes) {
    double num_runs = 0, num_clogs = 0, way = 0;
    for (const Run& run : size.runs) {
      num_runs += times[run.seed];
      num_clogs += run.is_clog ? times[run.seed] : 0;
      way += times[run.seed] * std::max(0.0, run.distance);
    }
    way_per_run += size.share * way / num_runs;
    clogs_per_run += size.share * num_clogs / num_runs;
    double num_at_risk = num_runs, probability = 1;  // the product-limit estimate
    auto run = size.runs.begin();
    for (std::size_t i = 0; i < places.size(); ++i) {
      for (; run != size.runs.end() && run->distance <= places[i]; ++run) {
        if (times[run->seed] == 0) continue;
        if (run->is_clog) probability *= 1 - times[run->seed] / num_at_risk;
        num_at_risk -= times[run->seed];
      }
      all.probabilities[i] += size.share * probability;
    }
  }
  all.length = clogs_per_run > 0 ? way_per_run / clogs_per_run : std::numeric_limits<double>::infinity();
  return all;
}

/// The strata of the seeds: each stratum contains the seeds that occur in the same set of sizes.
std::vector<std::vector<std::size_t>> strata_of(const std::vector<Size>& sizes, std::size_t num_seeds) {
  std::vector<std::set<std::size_t>> sizes_of(num_seeds);
  for (std::size_t i = 0; i < sizes.size(); ++i)
    for (const Run& run : sizes[i].runs) sizes_of[run.seed].insert(i);
  std::map<std::set<std::size_t>, std::vector<std::size_t>> strata;
  for (std::size_t seed = 0; seed < num_seeds; ++seed) strata[sizes_of[seed]].push_back(seed);
  std::vector<std::vector<std::size_t>> all;
  all.reserve(strata.size());
  for (auto& [key, seeds] : strata) all.push_back(std::move(seeds));
  return all;
}

/// Sets the intervals.
void resample(const std::vector<Size>& sizes, std::size_t num_seeds, double confidence, Mixture& mixture) {
  std::vector<double> places;
  for (const Mixture::Step& step : mixture.survival) places.push_back(step.distance);
  const std::vector<std::vector<std::size_t>> strata = strata_of(sizes, num_seeds);
  std::seed_seq sequence{std::uint32_t{0x313c70e5}};  // fixed, so that the output is reproducible
  boost::random::mt19937_64 engine(sequence);
  std::vector<double> lengths;
  std::vector<std::vector<double>> probabilities(places.size());
  for (int i = 0; i < num_resamples; ++i) {
    std::vector<int> times(num_seeds);
    for (const std::vector<std::size_t>& seeds : strata) {
      boost::random::uniform_int_distribution<std::size_t> draw(0, seeds.size() - 1);
      for (std::size_t j = 0; j < seeds.size(); ++j) ++times[seeds[draw(engine)]];
    }
    const Estimate one = estimate(sizes, times, places);
    lengths.push_back(one.length);
    for (std::size_t j = 0; j < places.size(); ++j) probabilities[j].push_back(one.probabilities[j]);
  }
  mixture.interval = fit::percentile_interval(lengths, num_seeds, confidence);
  for (std::size_t j = 0; j < places.size(); ++j)
    mixture.survival[j].interval = fit::percentile_interval(probabilities[j], num_seeds, confidence);
}

}  // namespace

Mixture mix(const std::string& text, const std::vector<Group>& groups, double confidence) {
  const auto equals = std::min(text.find('='), text.size());
  const Key key(console::trimmed(text.substr(0, equals)), text);
  Mixture mixture;
  mixture.column = key.name();
  mixture.parts = parts_of(equals == text.size() ? "" : text.substr(equals + 1), key, text);
  std::vector<const Group*> chosen;
  for (const Mixture::Part& part : mixture.parts)
    chosen.push_back(&find_group(key, part.value, groups, text));
  const bool is_in_mm = !have_one_scale(groups) && std::ranges::all_of(chosen, [](const Group* group) {
    return group->laboratory.has_value();
  });
  mixture.unit = is_in_mm ? "mm" : "sigma";
  std::vector<Size> sizes;
  std::map<std::uint32_t, std::size_t> seeds;
  double end = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (mixture.parts[i].share == 0) continue;
    Size& size = sizes.emplace_back(Size{mixture.parts[i].share, {}});
    for (std::size_t j = 0; j < chosen[i]->runs.size(); ++j)
      size.runs.push_back({chosen[i]->runs[j].distance * (is_in_mm ? chosen[i]->laboratory->length : 1),
                           chosen[i]->runs[j].clogged,
                           seeds.try_emplace(chosen[i]->seeds[j], seeds.size()).first->second});
    std::ranges::sort(size.runs, {}, [](const Run& run) { return std::pair(run.distance, !run.is_clog); });
    // Beyond the last distance, P is 0 if the last droplet clogged, otherwise P is unknown.
    if (!size.runs.back().is_clog) end = std::min(end, size.runs.back().distance);
  }
  std::set<double> places;
  for (const Size& size : sizes)
    for (const Run& run : size.runs)
      if (run.distance <= end) {
        if (run.is_clog)
          places.insert(run.distance);
        else
          mixture.censored_distances.push_back(run.distance);
      }
  std::ranges::sort(mixture.censored_distances);
  const Estimate all =
      estimate(sizes, std::vector<int>(seeds.size(), 1), std::vector<double>(places.begin(), places.end()));
  mixture.length = std::isfinite(all.length) ? all.length : unknown;
  for (const double place : places)
    mixture.survival.push_back({place, all.probabilities[mixture.survival.size()], {unknown, unknown}});
  resample(sizes, seeds.size(), confidence, mixture);
  return mixture;
}

std::string to_text(const Mixture& mixture, double confidence) {
  std::vector<std::string> parts;
  for (const Mixture::Part& part : mixture.parts)
    parts.push_back(fmt::format("{} ({:.4g} %)", part.value, 100 * part.share));
  const std::string text = fmt::format("mixture of {} {}: ", mixture.column, joined(parts));
  if (std::isnan(mixture.length)) return text + "lambda is unknown, because no droplet clogged\n";

  const auto [lambda, lower, upper] =
      console::with_interval(mixture.length, mixture.interval.lower, mixture.interval.upper);
  if (std::isnan(mixture.interval.lower))
    return text + fmt::format("lambda = {} {}, without an interval\n", lambda, mixture.unit);
  return text + fmt::format("lambda = {} ({}) {}, {:g} %\n", lambda,
                            std::isinf(mixture.interval.upper) ? "above " + lower : lower + " .. " + upper,
                            mixture.unit, 100 * confidence);
}

}  // namespace clog::results

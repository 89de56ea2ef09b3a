#include "clog/campaign/refiner.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "clog/campaign/groups.hpp"
#include "clog/core/model/model.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/fit/clogging_length.hpp"
#include "clog/fit/curve_features.hpp"
#include "clog/sweep/columns.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/row_check.hpp"
#include "clog/sweep/value_list.hpp"
#include "confidence.hpp"

namespace clog::campaign {
namespace {

constexpr std::size_t most_refined_keys = 2;

/// The values of a key in its list, in increasing order. @throws Error unless there are two, and all are
/// positive
std::vector<double> key_bounds(const sweep::Settings& settings, const std::string& name) {
  const sweep::Key& key = sweep::find_key(name);
  if (!key.parameter || key.parameter->role != ParameterRole::physics ||
      (key.kind != ValueKind::number && key.kind != ValueKind::number_or_share))
    throw Error(fmt::format("invalid --refine={} (is not a number of the physics)", name));
  std::vector<double> values;
  for (const std::string& text : settings.values(name)) {
    try {
      values.push_back(sweep::to_number(text));
    } catch (const Error&) {
      throw Error(fmt::format("invalid {}={} (--refine needs numbers)", name, settings.text(name)));
    }
  }
  if (values.size() < 2)
    throw Error(fmt::format("invalid {0}={1} (--refine {0} needs its bounds) try {0}={2},{3}", name,
                            settings.text(name), shortest(0.1), shortest(3)));
  if (std::ranges::adjacent_find(values, std::ranges::greater_equal()) != values.end())
    throw Error(fmt::format("invalid {}={} (with --refine values increase: the lower bound comes first)",
                            name, settings.text(name)));
  if (!(values.front() > 0))
    throw Error(fmt::format("invalid {}={} (--refine works on logarithms: values must be positive)", name,
                            settings.text(name)));
  return values;
}

/// Preferred numbers between the bounds, with these and the values that are given: as many to a decade as
/// make no more than `most`. The coarser series are parts of the finer ones.
std::vector<std::string> preferred_values(const std::vector<double>& given, std::size_t most) {
  std::map<double, std::string> values;
  for (const int per_decade : {192, 96, 48, 24, 12, 6}) {
    values.clear();
    for (const double value : given) values.emplace(value, shortest(value));
    const auto first = static_cast<int>(std::floor(per_decade * std::log10(given.front())));
    const auto last = static_cast<int>(std::ceil(per_decade * std::log10(given.back())));
    for (int i = first; i <= last; ++i) {
      const std::string text = fmt::format("{:.3g}", std::pow(10.0, static_cast<double>(i) / per_decade));
      const double value = sweep::to_number(text);
      if (value > given.front() && value < given.back()) values.emplace(value, shortest(value));
    }
    if (values.size() <= std::max(most, given.size() + 1)) break;
  }
  std::vector<std::string> texts;
  texts.reserve(values.size());
  for (const auto& [value, text] : values) texts.push_back(text);
  return texts;
}

/// Chooses `number` of the values, evenly on a logarithmic scale, including the outermost.
std::vector<std::string> spread(const std::vector<std::string>& values, std::size_t number) {
  const double low = std::log(sweep::to_number(values.front()));
  const double high = std::log(sweep::to_number(values.back()));
  std::vector<std::string> chosen;
  for (std::size_t i = 0; i < number; ++i) {
    const double place = low + (high - low) * static_cast<double>(i) / static_cast<double>(number - 1);
    const auto nearest = std::ranges::min_element(values, {}, [&](const std::string& text) {
      return std::abs(std::log(sweep::to_number(text)) - place);
    });
    if (chosen.empty() || chosen.back() != *nearest) chosen.push_back(*nearest);
  }
  return chosen;
}

std::string seed_range(std::int64_t first, std::int64_t number) {
  return number == 1 ? std::to_string(first) : fmt::format("{}..{}", first, first + number - 1);
}

/// The runs of a curve over some keys: those that differ from one of them in these keys and their results
/// only.
class CurveRuns {
 public:
  CurveRuns(const sweep::Settings& settings, std::span<const std::string> keys)
      : usual_(sweep::Plan(settings).task(0)), usual_row_(sweep::describe(usual_)) {
    for (const std::string& name : keys)
      for (const sweep::Column* column : group_columns())
        if (column->parameter == sweep::find_key(name).parameter) keys_.push_back(column);
  }

  const RunParameters& usual() const { return usual_; }
  std::size_t num_keys() const { return keys_.size(); }
  double value(const sweep::RunRow& row, std::size_t key) const {
    return std::get<double>(keys_[key]->get(row));
  }
  /// A column in which this run differs from those of the curve; null: it is one of them.
  const sweep::Column* other(const sweep::RunRow& row) const {
    for (const sweep::Column* column : group_columns())
      if (std::ranges::find(keys_, column) == keys_.end() && !column->may_be_automatic(usual_) &&
          column->get(row) != column->get(usual_row_))
        return column;
    return nullptr;
  }

 private:
  RunParameters usual_;
  sweep::RunRow usual_row_;
  std::vector<const sweep::Column*> keys_;
};

/// @throws Error if rows of these settings do not show which values the keys had, or if something else that
/// makes curves of its own changes with a key, as the density of a saturated array does with its gap
void require_one_curve(const sweep::Settings& settings, const std::vector<std::string>& keys) {
  const auto refuse = [&](const std::string& why) {
    throw Error(fmt::format("invalid --refine={} ({}) list values without --refine", joined(keys, ","), why));
  };
  const CurveRuns curve(settings, keys);
  if (curve.num_keys() != keys.size()) refuse("rows have no column of this key");
  const sweep::Plan plan(settings);
  const sweep::Points& points = settings.points();
  for (std::size_t key = 0; key < keys.size(); ++key) {
    std::set<double> given, found;
    for (const std::vector<std::string>& point : points.rows) given.insert(sweep::to_number(point[key]));
    for (std::int64_t task = 0; task < plan.size(); ++task) {
      const sweep::RunRow row = sweep::describe(plan.task(task));
      found.insert(curve.value(row, key));
      if (const sweep::Column* other = curve.other(row))
        refuse(fmt::format("{} changes with it: fix it, or", other->name));
    }
    if (found != given) refuse(fmt::format("rows have other values than {} is given", keys[key]));
  }
}

}  // namespace

/// The state of knowledge at one moment.
struct Refiner::Look {
  std::vector<RefinedPoint> points;
  RefinementCandidates candidates;
  std::vector<std::int64_t> num_seeds;   ///< of each candidate, failed runs included
  std::vector<std::int64_t> next_seeds;  ///< of each candidate
  std::vector<bool> is_hopeless;         ///< all runs there have failed
  std::vector<std::string> failures;     ///< points with failed runs, by name
  double seconds = 0;
  double work = 0;
  double expected_precision = 0;
  fit::Curve curve;
};

Refiner::Refiner(const sweep::Settings& settings, RefinementOptions options)
    : options_(std::move(options)), first_(settings) {
  const std::size_t num_keys = options_.keys.size();
  if (num_keys < 1 || num_keys > most_refined_keys || (num_keys == 2 && options_.keys[0] == options_.keys[1]))
    throw Error("invalid --refine=" + joined(options_.keys, ",") + " (names one key, or two different ones)");
  if (num_keys == 2 && options_.goal.kind == RefinementGoal::Kind::crossing)
    throw Error("invalid --until=" + options_.goal.text() +
                " (with two keys lambda crosses it along a line) give one key");
  require_one_value_of_others(settings, options_.keys);
  const std::vector<std::string>& seeds = settings.values("seeds");
  block_ = static_cast<std::int64_t>(seeds.size());
  first_seed_ = sweep::to_integer(seeds.front());
  for (std::int64_t i = 0; i < block_; ++i)
    if (sweep::to_integer(seeds[static_cast<std::size_t>(i)]) != first_seed_ + i)
      throw Error(fmt::format("invalid seeds={} (with --refine seeds follow one another) try seeds=1..4",
                              settings.text("seeds")));
  std::vector<std::vector<std::string>> first_values;
  for (const std::string& key : options_.keys) {
    constexpr std::size_t most_of_one_key = 100;
    constexpr std::size_t most_of_two_keys = 13;
    const std::vector<double> given = key_bounds(settings, key);
    values_.push_back(preferred_values(given, num_keys == 1 ? most_of_one_key : most_of_two_keys));
    constexpr std::size_t first_of_one_key = 7;
    constexpr std::size_t first_of_two_keys = 4;
    if (given.size() == 2)
      first_values.push_back(spread(values_.back(), num_keys == 1 ? first_of_one_key : first_of_two_keys));
    else
      first_values.push_back(settings.values(key));
  }
  const std::vector<std::vector<std::string>> places = combinations(first_values);
  std::vector<std::int64_t> next_seeds;
  for (std::size_t i = 0; i < places.size(); ++i)
    next_seeds.push_back(first_seed_ + (options_.seeds == RefinementOptions::Seeds::own
                                            ? static_cast<std::int64_t>(i) * block_
                                            : 0));
  first_.set_points(points_of(places, std::vector<std::int64_t>(places.size(), 1), next_seeds));
  require_one_curve(first_, options_.keys);
}

/// All combinations of the keys' values; the first key varies fastest.
std::vector<std::vector<std::string>> Refiner::combinations(
    const std::vector<std::vector<std::string>>& lists) const {
  std::vector<std::vector<std::string>> all;
  if (lists.size() == 1)
    for (const std::string& value : lists[0]) all.push_back({value});
  else
    for (const std::string& second : lists[1])
      for (const std::string& first : lists[0]) all.push_back({first, second});
  return all;
}

/// The points of the places that get blocks.
sweep::Points Refiner::points_of(const std::vector<std::vector<std::string>>& places,
                                 std::span<const std::int64_t> blocks,
                                 std::span<const std::int64_t> next_seeds) const {
  sweep::Points points{options_.keys, {}};
  points.keys.emplace_back("seeds");
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (blocks[i] == 0) continue;
    std::vector<std::string> row = places[i];
    row.push_back(seed_range(next_seeds[i], blocks[i] * block_));
    points.rows.push_back(std::move(row));
  }
  return points;
}

Refiner::Look Refiner::look(std::span<const sweep::RunRow> rows) const {
  Look found;
  const CurveRuns curve(first_, options_.keys);
  const auto values_at = [&](const sweep::RunRow& row) {
    return std::pair(curve.value(row, 0), curve.num_keys() > 1 ? curve.value(row, 1) : 1.0);
  };
  struct AtPlace {
    RefinedPoint point;
    std::int64_t num_runs = 0;
    std::int64_t num_failed = 0;
    std::int64_t last_seed = 0;
  };
  std::map<std::pair<double, double>, AtPlace> places;
  std::int64_t last_seed = first_seed_ - 1;
  for (const sweep::RunRow& row : rows) {
    if (curve.other(row) || !sweep::fault_of(row).empty() || sweep::is_unfinished(row.status)) continue;
    AtPlace& here = places[values_at(row)];
    ++here.num_runs;
    here.last_seed = std::max<std::int64_t>(here.last_seed, row.parameters.seed);
    last_seed = std::max<std::int64_t>(last_seed, row.parameters.seed);
    found.seconds += row.wall_seconds;
    if (row.status == RunStatus::failed) {
      ++here.num_failed;
      continue;
    }
    const auto [first, second] = values_at(row);
    here.point.place = {std::log(first), std::log(second)};
    here.point.num_clogs += row.status == RunStatus::clogged;
    here.point.distance += std::max(row.distance, 0.0);
    here.point.time += row.time;
    here.point.work += static_cast<double>(row.steps) * model_of(row.parameters).num_points(row.parameters);
  }
  for (const auto& [values, here] : places) {
    found.work += here.point.work;
    if (here.point.distance > 0 && here.point.time > 0) found.points.push_back(here.point);
    if (here.num_failed == 0) continue;
    std::string name = fmt::format("{}={}", options_.keys[0], shortest(values.first));
    if (curve.num_keys() > 1) name += fmt::format(" {}={}", options_.keys[1], shortest(values.second));
    found.failures.push_back(
        fmt::format("{} ({} of {})", name, here.num_failed, sweep::counted(here.num_runs, "run")));
  }
  found.candidates.max_time = curve.usual().max_time;
  for (const std::vector<std::string>& texts : combinations(values_)) {
    const std::pair<double, double> values(sweep::to_number(texts[0]),
                                           curve.num_keys() > 1 ? sweep::to_number(texts[1]) : 1);
    found.candidates.places.emplace_back(std::log(values.first), std::log(values.second));
    const auto here = places.find(values);
    const bool is_new = here == places.end();
    found.num_seeds.push_back(is_new ? 0 : here->second.num_runs);
    found.next_seeds.push_back(is_new ? first_seed_ : here->second.last_seed + 1);
    found.is_hopeless.push_back(!is_new && here->second.num_failed == here->second.num_runs);
  }
  if (options_.seeds == RefinementOptions::Seeds::own)
    found.next_seeds.assign(found.next_seeds.size(), last_seed + 1);
  if (found.points.empty()) return found;
  std::vector<fit::CurvePoint> points;
  for (const RefinedPoint& point : found.points)
    points.push_back({point.place, point.num_clogs, point.distance});
  found.curve = fit::fit_curve(points, found.candidates.places);
  return found;
}

std::optional<sweep::Points> Refiner::next_round(std::span<const sweep::RunRow> rows) {
  Look now = look(rows);
  if (now.points.empty()) {
    end_ = "no run got anywhere";
    return std::nullopt;
  }
  if (known_precision(now.curve, now.candidates.places, options_.goal) <= options_.goal.precision) {
    end_ = options_.goal.text() + " is reached";
    return std::nullopt;
  }
  RoundLimits limits{.seeds_per_block = block_, .blocks_left = {}, .work = share_of_round * now.work};
  if (std::isfinite(options_.budget))
    limits.most_work = std::max(0.0, options_.budget - now.seconds) * now.work / now.seconds;
  for (std::size_t i = 0; i < now.num_seeds.size(); ++i)
    limits.blocks_left.push_back(
        now.is_hopeless[i] ? 0
                           : std::max<std::int64_t>(0, (options_.most_seeds - now.num_seeds[i]) / block_));
  const std::vector<ExpectedRun> runs = expected_runs(now.points, now.candidates, now.curve.mean);
  const std::vector<std::int64_t> blocks = choose_blocks(now.curve, runs, options_.goal, limits);
  if (std::ranges::all_of(blocks, [](std::int64_t number) { return number == 0; })) {
    const bool may_grow = std::ranges::any_of(limits.blocks_left, [](std::int64_t left) { return left > 0; });
    end_ = may_grow ? "the budget is used up" : "no value may get more seeds (--most-seeds)";
    return std::nullopt;
  }
  if (options_.seeds == RefinementOptions::Seeds::own) {
    std::int64_t next = now.next_seeds.front();
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      now.next_seeds[i] = next;
      next += blocks[i] * block_;
    }
  }
  return points_of(combinations(values_), blocks, now.next_seeds);
}

std::string Refiner::text() const {
  const std::string goal = goal_or_budget(options_.goal.text(), options_.budget);
  return fmt::format(
      "values and seeds are added, in rounds, where they tell most of lambda over {} for their work, until "
      "{}; up to {} "
      "a value, {}",
      joined(options_.keys, " and "), goal, sweep::counted(options_.most_seeds, "seed"),
      options_.seeds == RefinementOptions::Seeds::own ? "each value with seeds of its own"
                                                      : "all values with the same");
}

std::vector<std::string> Refiner::rounds_in_words(double seconds_per_run) const {
  std::vector<std::string> words = {
      "this is the first round; each of the others is to cost half of all before it"};
  if (std::isfinite(options_.budget))
    words.push_back(fmt::format("all rounds: {:.2g} core-hours at most (--budget)", options_.budget / hour));
  if (options_.goal.kind == RefinementGoal::Kind::none) return words;
  if (options_.goal.kind != RefinementGoal::Kind::curve) {
    words.push_back(fmt::format("how much {} takes is known when its place is, after the first round",
                                options_.goal.text()));
    return words;
  }
  // An error e of log lambda takes 1/e^2 clogs at each of so many places that do not inform each other.
  const double error = std::asinh(options_.goal.precision) / fit::normal_deviate(default_confidence);
  const auto clogs = [&](std::size_t num_places) {
    return static_cast<double>(num_places) / (error * error);
  };
  const auto first_places = first_.points().rows.size();
  const std::size_t smoothest = 2;
  words.push_back(
      fmt::format("{} takes about {:.0f} clogs of a curve as smooth as a straight line, {:.0f} of one that "
                  "is new at each of the "
                  "first {} values: {:.2g} to {:.2g} core-hours in all if every run clogs",
                  options_.goal.text(), clogs(smoothest), clogs(first_places), first_places,
                  clogs(smoothest) * seconds_per_run / hour, clogs(first_places) * seconds_per_run / hour));
  return words;
}

std::string Refiner::known(std::span<const sweep::RunRow> rows) const {
  const Look now = look(rows);
  std::string text = end_.empty() ? "" : end_ + "; ";
  if (now.points.empty()) return text + "nothing is known";
  const RefinementGoal curve{RefinementGoal::Kind::curve, 0, 0};
  const fit::CurvePeak peak = fit::find_peak(now.curve, now.candidates.places, default_confidence);
  std::vector<std::string> at;
  for (std::size_t key = 0; key < options_.keys.size(); ++key) {
    const auto index = static_cast<Eigen::Index>(key);
    at.push_back(fmt::format("{} {:.3g} ({:.3g} to {:.3g})", options_.keys[key], std::exp(peak.place[index]),
                             std::exp(peak.place_lower[index]), std::exp(peak.place_upper[index])));
  }
  text += fmt::format(
      "lambda is known within {:.2g} % along the curve; highest at {}, with {:.3g} sigma ({:.3g} to {:.3g})",
      100 * known_precision(now.curve, now.candidates.places, curve), joined(at, ", "), peak.length,
      peak.interval.lower, peak.interval.upper);
  if (options_.goal.kind == RefinementGoal::Kind::crossing) {
    const auto crossings =
        fit::find_crossings(now.curve, now.candidates.places, options_.goal.length, default_confidence);
    if (crossings.empty())
      text += fmt::format("; it does not cross {} sigma", shortest(options_.goal.length));
    for (const fit::CurveCrossing& one : crossings)
      text += fmt::format("; it crosses {} sigma at {} {:.3g} ({:.3g} to {:.3g})",
                          shortest(options_.goal.length), options_.keys[0], std::exp(one.place),
                          std::exp(one.interval.lower), std::exp(one.interval.upper));
  }
  if (!now.failures.empty()) text += "; failed: " + joined(now.failures, ", ");
  return text;
}

}  // namespace clog::campaign

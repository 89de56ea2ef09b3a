#include "clog/results/seed_rule.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/fit/clogging_length.hpp"
#include "clog/results/groups.hpp"
#include "clog/sweep/columns.hpp"
#include "clog/sweep/keys.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/run_row.hpp"
#include "clog/sweep/value_list.hpp"
#include "confidence.hpp"

namespace clog::results {
namespace {

std::int64_t clogs_for(double precision) {
  std::int64_t enough = 1;
  while (fit::relative_half_width(enough, default_confidence) > precision) enough *= 2;
  std::int64_t too_few = enough / 2;
  while (enough - too_few > 1) {
    const std::int64_t middle = (too_few + enough) / 2;
    (fit::relative_half_width(middle, default_confidence) > precision ? too_few : enough) = middle;
  }
  return enough;
}

/// The columns in which parameter sets differ.
std::set<const sweep::Column*> differing_columns(const sweep::Plan& plan) {
  const sweep::RunRow first = sweep::describe(plan.task(0));
  std::set<const sweep::Column*> differing;
  for (std::int64_t group = 0; group < plan.num_groups(); ++group) {
    const sweep::RunRow row = sweep::describe(plan.task(group));
    for (const sweep::Column* column : group_columns())
      if (column->get(row) != column->get(first)) differing.insert(column);
  }
  return differing;
}

/// The keys by which a parameter set differs from the others, with their values.
std::string name_of(std::int64_t group, const sweep::Plan& plan,
                    const std::set<const sweep::Column*>& differing) {
  const sweep::RunRow row = sweep::describe(plan.task(group));
  std::vector<std::string> words;
  for (const sweep::Column* column : group_columns())
    if (differing.contains(column) && !column->may_be_automatic(row.parameters))
      words.push_back(column->name + '=' + sweep::text_of(column->get(row)));
  return words.empty() ? "the only one" : joined(words, " ");
}

}  // namespace

SeedRule::SeedRule(double precision, std::int64_t num_groups, std::int64_t first_seeds,
                   std::int64_t most_seeds)
    : precision_(precision),
      most_seeds_(most_seeds),
      num_seeds_(static_cast<std::size_t>(num_groups), first_seeds) {}

std::int64_t SeedRule::clogs_needed() const { return clogs_for(precision_); }

std::vector<std::int64_t> SeedRule::next_round(const std::function<RunStatus(std::int64_t task)>& status) {
  const std::int64_t needed = clogs_needed();
  std::vector<std::int64_t> tasks;
  num_reached_ = 0;
  unreached_.clear();
  for (std::int64_t group = 0; group < num_groups(); ++group) {
    std::int64_t& num_seeds = num_seeds_[static_cast<std::size_t>(group)];
    std::int64_t clogs = 0, failed = 0;
    for (std::int64_t seed = 0; seed < num_seeds; ++seed) {
      const RunStatus ended = status(seed * num_groups() + group);
      clogs += ended == RunStatus::clogged;
      failed += ended == RunStatus::failed;
    }
    num_reached_ += clogs >= needed;
    if (clogs >= needed) continue;
    unreached_.push_back({group, clogs, num_seeds, failed});
    if (failed == num_seeds) continue;
    const auto estimate =
        static_cast<std::int64_t>(std::ceil(static_cast<double>(num_seeds) * static_cast<double>(needed) /
                                            static_cast<double>(std::max<std::int64_t>(clogs, 1))));
    const std::int64_t next = std::min(std::clamp(estimate, num_seeds + 1, 2 * num_seeds), most_seeds_);
    for (std::int64_t seed = num_seeds; seed < next; ++seed) tasks.push_back(seed * num_groups() + group);
    num_seeds = std::max(num_seeds, next);
  }
  std::sort(tasks.begin(), tasks.end());  // seeds vary slowest, as in the plan
  return tasks;
}

std::string SeedRule::text() const {
  return fmt::format(
      "seeds are added, in rounds, to every parameter set with fewer than {} clogs (a 95 % interval of "
      "lambda within +-{} %), up to {}",
      clogs_needed(), sweep::shortest(100 * precision_), count_text(most_seeds_, "seed"));
}

std::string outcome(const SeedRule& rule, const sweep::Plan& plan) {
  const std::string sets = count_text(rule.num_groups(), "parameter set");
  std::string reached = fmt::format("{} of {} reached --until-precision", rule.num_reached(), sets);
  if (rule.unreached().empty()) return reached;
  constexpr std::size_t most_named = 4;
  const std::set<const sweep::Column*> differing = differing_columns(plan);
  std::vector<std::string> named;
  for (const SeedRule::Unreached& one : rule.unreached()) {
    if (named.size() == most_named) break;
    named.push_back(fmt::format("{} with {} of {} seeds{}", name_of(one.group, plan, differing),
                                count_text(one.num_clogs, "clog"), one.num_seeds,
                                one.num_failed > 0 ? fmt::format(", {} failed", one.num_failed) : ""));
  }
  if (rule.unreached().size() > most_named)
    named.push_back(fmt::format("{} more", rule.unreached().size() - most_named));
  return fmt::format("{}={} %; not: {} (it takes {} clogs); give more --most-seeds, or a longer max-time",
                     reached, sweep::shortest(100 * rule.precision()), joined(named), rule.clogs_needed());
}

GrowingSweep growing_sweep(const sweep::Settings& settings, double precision, std::int64_t most_seeds) {
  const std::string& key = sweep::seeds_key().name;
  const std::vector<std::string>& seeds = settings.values(key);
  const auto first_seeds = static_cast<std::int64_t>(seeds.size());
  const sweep::Plan plan(settings);
  for (std::int64_t group = 0; group < plan.num_groups(); ++group)
    if (const std::string why = sweep::why_nothing_is_random(plan.group(group)); !why.empty())
      throw Error(fmt::format(
          "no place for --until-precision (nothing is random with {}, so more seeds repeat the same "
          "run); sweep parameter sets with {} apart, without it",
          why, why));
  if (!plan.has_equal_seeds() || plan.size() != plan.num_groups() * first_seeds ||
      !settings.shard().is_whole())
    throw Error(
        "--until-precision needs the same first seeds in all parameter sets, and the whole sweep; remove "
        "seeds from the points, and --shard");
  GrowingSweep sweep{settings, plan.size(), {precision, plan.num_groups(), first_seeds, most_seeds}};
  if (most_seeds == first_seeds) return sweep;
  long long last = 0;
  for (const std::string& seed : seeds) last = std::max(last, sweep::to_integer(seed));
  constexpr long long largest_seed = 4'294'967'295;
  if (last + most_seeds - first_seeds > largest_seed)
    throw Error(
        fmt::format("invalid --most-seeds={} (seeds after {} would exceed {}) begin with smaller seeds",
                    most_seeds, last, largest_seed));
  sweep.settings.set(key,
                     fmt::format("{},{}..{}", settings.text(key), last + 1, last + most_seeds - first_seeds));
  return sweep;
}

}  // namespace clog::results

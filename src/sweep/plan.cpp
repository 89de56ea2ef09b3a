#include "clog/sweep/plan.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

#include "clog/core/parameters/schema.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/core/world/lattice.hpp"
#include "clog/sweep/run_row.hpp"
#include "clog/sweep/value_list.hpp"
#include "refusal_hints.hpp"

namespace clog::sweep {
namespace {

constexpr std::int64_t largest_sweep = 100'000'000;

/// Calls check() for one branch of the settings, and returns its result. If the check refuses a value,
/// perhaps because of a list, the message suggests what the user may have meant.
/// @param lists  see hint_at_list() @param where  beginning of the message
template <class Check>
auto checked(const Settings& branch, const Settings& lists, const std::string& where,
             const Check& check) try {
  return check();
} catch (const Refusal& refusal) {
  throw refusal.between(where, hint_at_list(branch, lists, refusal));
} catch (const Error& error) {
  throw Error(where + error.what());
}

std::vector<std::uint32_t> seeds_of(const Settings& settings) {
  const Key& key = seeds_key();
  std::vector<std::uint32_t> seeds;
  for (const std::string& text : settings.values(key.name)) {
    RunParameters run;
    key.apply(run, text);
    seeds.push_back(run.seed);
  }
  return seeds;
}

/// The seeds of a shard: every n-th seed. The first seed of the shard differs between parameter sets, so that
/// all shards have equal work.
std::vector<std::uint32_t> part_of(const std::vector<std::uint32_t>& seeds, std::size_t share,
                                   const Shard& shard) {
  const auto of = static_cast<std::size_t>(shard.of);
  std::vector<std::uint32_t> part;
  for (std::size_t place = 0; place < seeds.size(); ++place)
    if ((place + share) % of == static_cast<std::size_t>(shard.number - 1)) part.push_back(seeds[place]);
  return part;
}

/// Whether each parameter is possible by itself. If not, resolve() names the impossible parameter.
bool is_each_possible(const RunParameters& run) try {
  check_each(run);
  return true;
} catch (const Error&) {
  return false;
}

}  // namespace

/// Fills a plan, one branch of the settings after the other.
class Plan::Builder {
 public:
  explicit Builder(Plan& plan) : plan_(plan) {}

  void add_all(const Settings& settings) {
    settings.visit_branches([&](const Settings& branch, std::int64_t point) {
      if (point < 0)
        add_branch(branch, settings, "");
      else
        add_point(branch, settings, point);
    });
    if (!settings.shard().is_whole()) keep(settings.shard());
    find_twins();
    number_tasks();
  }

 private:
  Plan& plan_;
  std::unordered_map<std::string, std::int64_t> known_;  // groups, by identity()
  std::unordered_map<std::string, std::int64_t> runs_;   // first groups, by identity_in_any_laboratory()
  std::vector<std::string> names_;  // names of products, for messages; empty without points
  std::int64_t num_runs_ = 0;       // number of runs of all shards
  Seeds last_seeds_;                // shared by branches with the same seeds

  /// @param common  settings with the points
  void add_point(const Settings& branch, const Settings& common, std::int64_t point) try {
    add_branch(branch, branch, fmt::format("point {}", point + 1));
  } catch (const Refusal& refusal) {
    throw Refusal(refusal.about(), refusal_of_point(common, static_cast<std::size_t>(point), refusal));
  }

  /// @param lists  see hint_at_list() @param name  name of the branch, for messages
  void add_branch(const Settings& branch, const Settings& lists, const std::string& name) {
    const std::string where = name.empty() ? "" : name + ": ";
    checked(branch, lists, where, [&] { refuse_contradictions(branch); });
    names_.push_back(name);
    add_product(branch);
    const std::size_t product = plan_.products_.size() - 1;
    std::vector<std::uint32_t> seeds = seeds_of(branch);
    if (!last_seeds_ || *last_seeds_ != seeds)
      last_seeds_ = std::make_shared<const std::vector<std::uint32_t>>(std::move(seeds));
    const std::int64_t num_places = size_of_product(branch);
    if (branch.text("obstacle-layout") == "lattice") refuse_misfitting_angles(product, num_places, where);
    for (std::int64_t place = 0; place < num_places; ++place) {
      const RunRow run = checked(branch, lists, where, [&] {
        return describe(plan_.parameters(product, place, last_seeds_->front()));
      });
      add_group(run, product, place);
    }
  }

  void add_product(const Settings& branch) {
    OwnLists& own = plan_.products_.emplace_back();
    const bool is_first = plan_.axes_.empty();
    for (const Key& key : keys())
      if (is_first && !key.is_ensemble()) plan_.axes_.push_back({&key, branch.values(key.name)});
    for (std::size_t axis = 0; axis < plan_.axes_.size(); ++axis)
      if (const auto& values = branch.values(plan_.axes_[axis].key->name); values != plan_.axes_[axis].values)
        own[axis] = values;
  }

  /// Refuses all angles that do not fit the box, in one message; resolve() would name only the first of them.
  void refuse_misfitting_angles(std::size_t product, std::int64_t num_places,
                                const std::string& where) const {
    std::vector<std::string> angles;
    double box = 0;
    for (std::int64_t place = 0; place < num_places; ++place) {
      const RunParameters run = plan_.unresolved(product, place, last_seeds_->front());
      const ObstacleParameters& obstacles = run.obstacles;
      const bool is_possible = is_each_possible(run) && obstacles.layout == ObstacleLayout::lattice &&
                               obstacles.box <= 1e4 * obstacles.spacing();  // else check_spacing refuses
      if (!is_possible || fitting_lattice(obstacles)) continue;
      const std::string angle = shortest(obstacles.lattice_angle);
      if (std::ranges::find(angles, angle) != angles.end()) continue;
      angles.push_back(angle);
      box = std::max(box, box_that_fits(obstacles));
    }
    if (angles.size() > 1)
      throw Refusal({.key = "lattice-angle"}, joined(angles, ","),
                    fmt::format("no lattice within {:.3g} degrees of any of these has so short a period",
                                largest_angle_error),
                    fmt::format("use box={} or more, or leave them out", box))
          .between(where, "");
  }

  /// The number of groups in the product of the lists. Also checks that the number of runs is not too large.
  std::int64_t size_of_product(const Settings& branch) {
    auto num_places = std::int64_t{1};
    const std::int64_t num_seeds = std::ssize(*last_seeds_);
    for (const Axis& axis : plan_.axes_) {
      num_places *= std::ssize(branch.values(axis.key->name));
      if (num_runs_ + num_places * num_seeds > largest_sweep)
        throw Error("the sweep has more than a hundred million runs; shorten its lists");
    }
    num_runs_ += num_places * num_seeds;
    return num_places;
  }

  /// Different texts may mean the same parameter set: tilts of the same lattice, or `auto` and its value.
  /// Equal parameter sets with different seeds form one group.
  void add_group(RunRow run, std::size_t product, std::int64_t place) {
    run.parameters.seed = 0;
    const auto [known, is_new] = known_.emplace(identity(run), plan_.num_groups());
    if (is_new) {
      const std::int64_t group = known->second;
      const bool has_laboratory = run.parameters.laboratory.has_value();
      const std::int64_t runs =
          has_laboratory ? runs_.emplace(identity_in_any_laboratory(std::move(run)), group).first->second
                         : group;
      plan_.groups_.push_back({product, place, last_seeds_, runs});
      return;
    }
    refuse_repeated_seeds(known->second, product);
    Seeds& seeds = plan_.groups_[static_cast<std::size_t>(known->second)].seeds;
    std::vector<std::uint32_t> all = *seeds;
    all.insert(all.end(), last_seeds_->begin(), last_seeds_->end());
    seeds = std::make_shared<const std::vector<std::uint32_t>>(std::move(all));
  }

  void refuse_repeated_seeds(std::int64_t number, std::size_t product) const {
    const Group& group = plan_.groups_[static_cast<std::size_t>(number)];
    const std::set<std::uint32_t> seen(group.seeds->begin(), group.seeds->end());
    for (const std::uint32_t seed : *last_seeds_) {
      if (!seen.contains(seed)) continue;
      const std::string& here = names_[product];
      const std::string& there = names_[group.product];
      throw Error(
          here.empty() || there.empty()
              ? fmt::format("the sweep's lists lead to the same run twice (parameter sets {} and {} mean the "
                            "same); leave one of them out",
                            number, plan_.num_groups())
              : fmt::format("{} and {} mean the same run with seed {}; leave one of them out", there, here,
                            seed));
    }
  }

  /// Keeps the shard's part of a product.
  void keep(const Shard& shard) {
    std::vector<Group> groups;
    for (Group group : plan_.groups_) {
      group.seeds = std::make_shared<const std::vector<std::uint32_t>>(
          part_of(*group.seeds, static_cast<std::size_t>(group.runs), shard));
      if (!group.seeds->empty()) groups.push_back(std::move(group));
    }
    if (groups.empty())
      throw Error(fmt::format("part {} of the sweep is empty: the whole sweep has only {}", shard.text(),
                              count_text(num_runs_, "run")));
    plan_.groups_ = std::move(groups);
  }

  void find_twins() {
    std::unordered_map<std::int64_t, std::int64_t> first_groups;
    for (std::int64_t i = 0; i < plan_.num_groups(); ++i) {
      Group& group = plan_.groups_[static_cast<std::size_t>(i)];
      const auto [first, is_new] = first_groups.emplace(group.runs, i);
      if (!is_new && *plan_.groups_[static_cast<std::size_t>(first->second)].seeds == *group.seeds)
        group.twin = first->second;
      if (group.twin < 0) plan_.num_runs_ += std::ssize(*group.seeds);
    }
  }

  void number_tasks() {
    std::set<std::size_t> numbers;
    for (const Group& group : plan_.groups_) numbers.insert(group.seeds->size());
    std::size_t first = 0;
    for (const std::size_t number : numbers) {
      Layer layer{plan_.size_, static_cast<std::int64_t>(first), {}};
      for (std::size_t i = 0; i < plan_.groups_.size(); ++i)
        if (plan_.groups_[i].seeds->size() >= number) layer.groups.push_back(static_cast<std::int64_t>(i));
      plan_.size_ += static_cast<std::int64_t>((number - first) * layer.groups.size());
      plan_.layers_.push_back(std::move(layer));
      first = number;
    }
  }
};

Plan::Plan(const Settings& settings) : circle_files_(settings.circle_files()) {
  for (const Key& key : keys())
    if (std::string words = possible_decimal(key, settings); !words.empty())
      possible_decimals_.push_back(std::move(words));
  Builder(*this).add_all(settings);
}

const Plan::Layer& Plan::layer_of(std::int64_t task) const {
  assert(task >= 0 && task < size_);
  const auto next = std::upper_bound(layers_.begin(), layers_.end(), task,
                                     [](std::int64_t t, const Layer& layer) { return t < layer.first_task; });
  return *std::prev(next);
}

/// The place of the task's seed among the seeds of its group.
std::int64_t Plan::seed_place(std::int64_t task) const {
  const Layer& layer = layer_of(task);
  return layer.first_seed + (task - layer.first_task) / std::ssize(layer.groups);
}

RunParameters Plan::task(std::int64_t index) const {
  const Group& group = groups_[static_cast<std::size_t>(group_of(index))];
  return parameters(group.product, group.place, (*group.seeds)[static_cast<std::size_t>(seed_place(index))]);
}

std::optional<std::int64_t> Plan::twin(std::int64_t task) const {
  const std::int64_t group = groups_[static_cast<std::size_t>(group_of(task))].twin;
  if (group < 0) return std::nullopt;
  return task_of(group, seed_place(task));
}

RunParameters Plan::group(std::int64_t group) const {
  const Group& one = groups_[static_cast<std::size_t>(group)];
  return parameters(one.product, one.place, one.seeds->front());
}

std::int64_t Plan::group_of(std::int64_t task) const {
  const Layer& layer = layer_of(task);
  return layer.groups[static_cast<std::size_t>((task - layer.first_task) % std::ssize(layer.groups))];
}

std::int64_t Plan::num_seeds(std::int64_t group) const {
  return std::ssize(*groups_[static_cast<std::size_t>(group)].seeds);
}

std::vector<std::uint32_t> Plan::seeds(std::int64_t group) const {
  return *groups_[static_cast<std::size_t>(group)].seeds;
}

std::int64_t Plan::task_of(std::int64_t group, std::int64_t place) const {
  // Finds the last layer that begins with this seed or an earlier seed.
  const auto next = std::ranges::upper_bound(layers_, place, {}, &Layer::first_seed);
  const Layer& layer = *std::prev(next);
  const auto found = std::ranges::lower_bound(layer.groups, group);
  assert(found != layer.groups.end() && *found == group);  // otherwise the group has no such seed
  return layer.first_task + (place - layer.first_seed) * std::ssize(layer.groups) +
         std::distance(layer.groups.begin(), found);
}

/// The texts of a parameter set, one for every axis.
std::vector<const std::string*> Plan::texts(std::size_t product, std::int64_t place) const {
  const OwnLists& own = products_[product];
  std::vector<const std::string*> texts(axes_.size());
  for (std::size_t i = axes_.size(); i-- > 0;) {
    const auto found = own.find(i);
    const std::vector<std::string>& values = found == own.end() ? axes_[i].values : found->second;
    texts[i] = &values[static_cast<std::size_t>(place % std::ssize(values))];
    place /= std::ssize(values);
  }
  return texts;
}

std::vector<std::string> Plan::texts(std::int64_t group) const {
  const Group& one = groups_[static_cast<std::size_t>(group)];
  std::vector<std::string> all;
  for (const std::string* text : texts(one.product, one.place)) all.push_back(*text);
  all.insert(all.begin() + static_cast<std::ptrdiff_t>(place_of_key(seeds_key().name)), "");
  return all;
}

RunParameters Plan::parameters(std::size_t product, std::int64_t place, std::uint32_t seed) const {
  return resolve(unresolved(product, place, seed));
}

RunParameters Plan::unresolved(std::size_t product, std::int64_t place, std::uint32_t seed) const {
  const std::vector<const std::string*> values = texts(product, place);
  RunParameters run;
  for (std::size_t i = axes_.size(); i-- > 0;)
    if (axes_[i].key->kind == ValueKind::file && *values[i] != "none")
      run.obstacles.own = circle_files_.at(*values[i]);
    else
      axes_[i].key->apply(run, *values[i]);
  run.seed = seed;
  return run;
}

RunParameters single_run(const Settings& settings) {
  const Plan plan(settings);
  if (plan.size() == 1) return plan.task(0);
  throw Error(fmt::format(
      "these settings describe {} runs, but one is needed; give single values, with a point where "
      "they have decimals, or use clogsweep",
      plan.size()));
}

}  // namespace clog::sweep

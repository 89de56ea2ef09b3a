#include "clog/results/run_list.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/sweep/keys.hpp"
#include "clog/sweep/row_check.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::results {
namespace {

using Texts = std::vector<std::string>;

constexpr std::size_t longest_list = 2500;  // longest text of a key; longer lists become points

std::string identity_without_seed(sweep::RunRow run) {
  run.parameters.seed = 0;
  return sweep::identity_in_any_version(std::move(run));
}

double number_or_infinity(const std::string& text) try {
  return sweep::to_number(text);
} catch (const Error&) {
  return std::numeric_limits<double>::infinity();
}

/// Order of texts: numbers by size, then other texts.
bool is_less(const std::string& a, const std::string& b) {
  return std::pair(number_or_infinity(a), a) < std::pair(number_or_infinity(b), b);
}

bool is_run(const RunParameters& run, const sweep::RunRow& row) {
  return sweep::identity_in_any_version(sweep::describe(run)) == sweep::identity_in_any_version(row);
}

/// The seeds as text, such as `1..10,15`; several texts if there are many gaps between the seeds.
Texts texts_of(const std::set<std::uint32_t>& seeds) {
  Texts texts;
  std::string text;
  for (auto first = seeds.begin(); first != seeds.end();) {
    auto last = first;
    while (std::next(last) != seeds.end() && *std::next(last) == *last + 1) ++last;
    if (text.size() > longest_list) texts.push_back(std::exchange(text, ""));
    if (!text.empty()) text += ',';
    text += *first == *last ? std::to_string(*first) : fmt::format("{}..{}", *first, *last);
    first = std::next(last);
  }
  texts.push_back(text);
  return texts;
}

void set_all(sweep::Settings& settings, const Texts& texts) {
  for (std::size_t i = 0; i < texts.size(); ++i)
    if (!texts[i].empty()) settings.set(sweep::keys()[i].name, texts[i]);
}

/// Texts of a plan's first parameter set, changed to the row's values where these differ; nullopt if the name
/// of a file is unknown.
std::optional<Texts> texts_of(const sweep::RunRow& row, const sweep::Plan& plan) {
  const sweep::RunRow first = sweep::describe(plan.group(0));
  Texts texts = plan.texts(0);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const sweep::Key& key = sweep::keys()[i];
    if (key.is_ensemble()) continue;
    if (!key.parameter) {
      if (row.preset != first.preset && sweep::has_named_preset(row)) texts[i] = row.preset;
      continue;
    }
    const ParameterValue value = key.parameter->get(row.parameters);
    if (value == key.parameter->get(first.parameters)) continue;
    if (key.kind == ValueKind::file) return std::nullopt;
    texts[i] = sweep::written(value, *key.parameter);
  }
  return texts;
}

}  // namespace

void RunList::add(const sweep::Plan& plan) {
  for (std::int64_t group = 0; group < plan.num_groups(); ++group) {
    ParameterSet& set = set_of(plan, sweep::describe(plan.group(group)), plan.texts(group));
    const std::vector<std::uint32_t> seeds = plan.seeds(group);
    set.seeds.insert(seeds.begin(), seeds.end());
  }
}

RunList::ParameterSet& RunList::set_of(const sweep::Plan& plan, const sweep::RunRow& run,
                                       std::vector<std::string> texts) {
  for (const auto& [name, circles] : plan.circle_files()) {
    const auto [known, is_new] = circle_files_.emplace(name, circles);
    if (!is_new && !(known->second == circles))
      throw Error(
          fmt::format("two files contain different circles under the same name {}; "
                      "sweeps with different circles cannot be joined under one name",
                      name));
  }
  const auto [place, is_new] = places_.emplace(identity_without_seed(run), sets_.size());
  if (is_new) sets_.push_back({std::move(texts), {}, sweep::why_nothing_is_random(run.parameters).empty()});
  return sets_[place->second];
}

bool RunList::add_seed(const sweep::RunRow& row) {
  const auto known = places_.find(identity_without_seed(row));
  if (known == places_.end()) return false;
  sets_[known->second].seeds.insert(row.parameters.seed);
  return true;
}

void RunList::fill_seeds(std::size_t number) {
  for (ParameterSet& set : sets_)
    for (std::uint32_t seed = 1; set.is_random && set.seeds.size() < number; ++seed) set.seeds.insert(seed);
}

namespace {

/// Whether these texts, with the seed of the row and the circles of the plan, describe the row's run.
bool describe_run(const Texts& texts, const sweep::RunRow& row, const sweep::Plan& plan) try {
  sweep::Settings settings;
  set_all(settings, texts);
  settings.set(sweep::seeds_key().name, std::to_string(row.parameters.seed));
  for (const auto& [name, circles] : plan.circle_files()) settings.attach(name, circles);
  return is_run(sweep::Plan(settings).task(0), row);
} catch (const Error&) {  // the row is from a version with other keys or ranges
  return false;
}

}  // namespace

bool RunList::add(const sweep::Plan& plan, const sweep::RunRow& row) {
  if (add_seed(row)) return true;
  const bool is_of_plan = row.task >= 0 && row.task < plan.size() && is_run(plan.task(row.task), row);
  std::optional<Texts> texts = is_of_plan ? plan.texts(plan.group_of(row.task)) : texts_of(row, plan);
  if (!texts || (!is_of_plan && !describe_run(*texts, row, plan))) return false;
  set_of(plan, row, std::move(*texts)).seeds.insert(row.parameters.seed);
  return true;
}

void RunList::add_rows(const std::string& path, const sweep::Plan& plan,
                       const std::vector<sweep::RunRow>& rows) {
  const auto num_left_out = std::ranges::count_if(
      rows, [&](const sweep::RunRow& row) { return !add(plan, row) && sweep::fault_of(row).empty(); });
  if (num_left_out > 0)
    console::say(fmt::format("{}: no settings of this version describe {}; the rows are kept", path,
                             count_text(num_left_out, "run")));
}

namespace {

/// Places of the keys that have different texts.
std::vector<std::size_t> differing_places(const std::vector<const Texts*>& all) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < all.front()->size(); ++i)
    if (std::ranges::any_of(all, [&](const Texts* one) { return (*one)[i] != (*all.front())[i]; }))
      places.push_back(i);
  return places;
}

/// Every different text of a key.
Texts values_of(const std::vector<const Texts*>& all, std::size_t place) {
  Texts values;
  values.reserve(all.size());
  for (const Texts* one : all) values.push_back((*one)[place]);
  std::ranges::sort(values, is_less);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

}  // namespace

sweep::Settings RunList::settings() const {
  assert(!empty());
  std::vector<const Texts*> all;
  all.reserve(sets_.size());
  for (const ParameterSet& set : sets_) all.push_back(&set.texts);
  const std::vector<std::size_t> differing = differing_places(all);
  const bool have_same_seeds =
      std::ranges::all_of(sets_, [&](const ParameterSet& set) { return set.seeds == sets_.front().seeds; });
  sweep::Settings settings;
  set_all(settings, sets_.front().texts);
  for (const auto& [name, circles] : circle_files_) settings.attach(name, circles);
  const Texts seeds = texts_of(sets_.front().seeds);
  bool is_product = have_same_seeds && seeds.size() == 1;
  std::size_t size = 1;
  std::vector<std::string> lists;
  for (const std::size_t place : differing) {
    const Texts values = values_of(all, place);
    size *= values.size();
    lists.push_back(joined(values, ","));
    is_product = is_product && lists.back().size() < longest_list;
  }
  if (is_product && size == sets_.size()) {
    for (std::size_t i = 0; i < differing.size(); ++i)
      settings.set(sweep::keys()[differing[i]].name, lists[i]);
    settings.set(sweep::seeds_key().name, seeds.front());
    return settings;
  }
  settings.set_points(points(differing));
  return settings;
}

sweep::Points RunList::points(const std::vector<std::size_t>& differing) const {
  sweep::Points points;
  for (const std::size_t place : differing) points.keys.push_back(sweep::keys()[place].name);
  points.keys.push_back(sweep::seeds_key().name);
  for (const ParameterSet& set : sets_)
    for (const std::string& seeds : texts_of(set.seeds)) {
      Texts& row = points.rows.emplace_back();
      for (const std::size_t place : differing) row.push_back(set.texts[place]);
      row.push_back(seeds);
    }
  std::ranges::sort(points.rows, [](const Texts& a, const Texts& b) {
    return std::ranges::lexicographical_compare(a, b, is_less);
  });
  return points;
}

}  // namespace clog::results

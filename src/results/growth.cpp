#include "clog/results/growth.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <utility>

#include "clog/core/tools/joined.hpp"

namespace clog::results {
namespace {

bool may_grow_along(const sweep::Key& key) {
  return key.parameter && key.kind != ValueKind::word && key.parameter->role != ParameterRole::numerics;
}

/// Whether one of the key's texts, such as `auto`, means that the value follows from other keys.
bool has_automatic_text(const sweep::Key& key, const sweep::Settings& settings) {
  return key.kind != ValueKind::word &&
         std::ranges::any_of(settings.values(key.name), [&](const std::string& value) {
           return std::ranges::find(key.words, value) != key.words.end();
         });
}

/// Whether two lists have a common value. Equal numbers may be written differently.
bool have_common_value(const std::vector<std::string>& some, const std::vector<std::string>& others) {
  return std::any_of(some.begin(), some.end(), [&](const std::string& value) {
    return std::any_of(others.begin(), others.end(),
                       [&](const std::string& other) { return sweep::is_same_value(value, other); });
  });
}

/// A key's values: as the user typed them, or all values of the points.
std::string shown(const sweep::Settings& settings, const sweep::Key& key,
                  const std::map<std::string, std::vector<std::string>>& values) {
  const std::vector<std::string>& all = values.at(key.name);
  return all == settings.values(key.name) ? settings.text(key.name) : joined(all, ",");
}

void append(std::string& all, const std::string& key, const std::string& here, const std::string& there) {
  all += fmt::format("{}{}={} (file: {})", all.empty() ? "" : ", ", key, here, there);
}

}  // namespace

std::string differing_keys(const sweep::Settings& there, const sweep::Settings& here) {
  std::string all;
  const auto values_there = there.all_values();
  const auto values_here = here.all_values();
  for (const sweep::Key& key : sweep::keys())
    if (!may_grow_along(key) && key.parameter &&
        !have_common_value(values_there.at(key.name), values_here.at(key.name)))
      append(all, key.name, shown(here, key, values_here), shown(there, key, values_there));
  return all;
}

FixedValues::FixedValues(const sweep::Plan& plan, sweep::Settings settings) : settings_(std::move(settings)) {
  for (const sweep::Key& key : sweep::keys())
    if (key.parameter && !may_grow_along(key) && !has_automatic_text(key, settings_))
      keys_.push_back({&key, {}});
  for (std::int64_t group = 0; group < plan.num_groups(); ++group) {
    const RunParameters run = plan.group(group);
    for (auto& [key, values] : keys_) values.insert(key->parameter->get(run));
  }
}

std::string FixedValues::differing_keys(const sweep::RunRow& row) const {
  if (row.model_version != model_version)
    return fmt::format("model version {} (file: {})", model_version, row.model_version);
  std::string all;
  for (const auto& [key, values] : keys_) {
    const ParameterValue value = key->parameter->get(row.parameters);
    if (key->parameter->applies_to(row.parameters) && !values.contains(value))
      append(all, key->name, settings_.text(key->name), sweep::written(value, *key->parameter));
  }
  return all;
}

}  // namespace clog::results

#include "clog/sweep/settings.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::sweep {
namespace {

constexpr const char* layout_key = "obstacle-layout";

bool is_of_channel(const Key& key) {
  return key.parameter && key.parameter->scope->word == std::string_view("channel");
}

/// The scene of a layout; nullptr if the text is none, such as a list.
const Scene* scene_in(const std::string& text) {
  const std::optional<ObstacleLayout> layout = meant_by<ObstacleLayout>(text);
  return layout ? &scene_of(*layout) : nullptr;
}

std::string refused_value(const std::string& name, const std::string& text, const std::string& why) {
  constexpr std::size_t longest_shown = 60;
  const std::string shown = text.size() > longest_shown ? text.substr(0, longest_shown) + "..." : text;
  return fmt::format("invalid {}={} ({})", name, shown, why);
}

std::string unit_in_words(const Key& key) {
  const std::string unit = key.parameter ? key.parameter->unit : "";
  return unit.empty() ? "a pure number" : "in " + unit;
}

/// The list of a key, each value of which some run can have. @throws Error that names the key
std::vector<std::string> values_of(const Key& key, const std::string& text) {
  constexpr std::size_t longest_text = 3000;  // in a config
  try {
    if (text.size() > longest_text)
      throw Error("the list is too long to be stored; ranges like 1..15000 are short");
    std::vector<std::string> values = expand_list(text, key.kind, key.words);
    for (const std::string& value : values) {
      RunParameters scratch;
      key.apply(scratch, value);
    }
    return values;
  } catch (const NumberWithUnit& error) {
    throw NumberWithUnit(refused_value(
        key.name, text,
        fmt::format("{}; numbers have no unit here: this one is {}", error.what(), unit_in_words(key))));
  } catch (const Error& error) {
    throw Error(refused_value(key.name, text, error.what()));
  }
}

/// Calls for each combination of single words.
void visit_words(const Settings& settings, const std::function<void(const Settings&)>& visit) {
  for (const Key& key : keys()) {
    const std::vector<std::string>& words = settings.values(key.name);
    if (key.kind != ValueKind::word || words.size() == 1) continue;
    for (const std::string& word : words) {
      Settings one = settings;
      one.set(key.name, word);
      visit_words(one, visit);
    }
    return;
  }
  visit(settings);
}

/// @param plain  settings without points
void visit_points(const Settings& plain, const Points& points, const Settings::VisitBranch& visit) {
  for (std::size_t i = 0; i < points.rows.size(); ++i) {
    Settings one = plain;
    for (std::size_t k = 0; k < points.keys.size(); ++k)
      if (const std::string& text = points.rows[i][k]; !text.empty()) one.set(points.keys[k], text);
    visit_words(one, [&](const Settings& branch) { visit(branch, static_cast<std::int64_t>(i)); });
  }
}

}  // namespace

void Settings::set(const std::string& name, const std::string& text) {
  given_[name] = {text, values_of(find_key(name), text)};
  is_resolved_ = false;
}

const Settings::Entry& Settings::entry(const std::string& name) const {
  if (!is_resolved_)
    for (auto& [key, now] : resolved())
      if (Entry& known = all_[key]; known.values.empty() || known.text != now.text) known = std::move(now);
  is_resolved_ = true;
  return all_.at(name);
}

/// What was given, what follows from it for other keys, and the defaults. The keys of a preset, the layout
/// and the seeds follow: user-supplied circles and keys of a channel set the layout, and where nothing is
/// random there is one seed.
Settings::Entries Settings::resolved() const {
  static const Entries defaults = [] {
    Entries entries;
    for (const Key& key : keys()) entries[key.name] = {key.default_text, values_of(key, key.default_text)};
    return entries;
  }();
  Entries all = given_;
  all.insert(defaults.begin(), defaults.end());
  const auto follow = [&](const char* key, const char* text) {
    if (!is_given(key)) all[key] = {text, values_of(find_key(key), text)};
  };
  for (const auto& [key, text] : preset_texts(all.at("preset").text)) follow(key, text);
  const bool has_circles = all.at(circles_key).text != "none";
  if (has_circles)
    follow(layout_key, "file");
  else if (std::ranges::any_of(given_, [](const auto& one) { return is_of_channel(find_key(one.first)); }))
    follow(layout_key, "channel");
  const Scene* const scene = scene_in(all.at(layout_key).text);
  const bool is_wall = scene && scene->walls_from == WallsFrom::droplet;
  if (is_wall || (has_circles && all.at("release").text == "centre")) follow("seeds", "1");
  return all;
}

const Scene* Settings::scene() const { return scene_in(text(layout_key)); }

std::vector<std::string> Settings::missing_files() const {
  std::vector<std::string> missing;
  const auto look = [&](const std::vector<std::string>& files) {
    for (const std::string& file : files)
      if (file != "none" && !circle_files_.contains(file) &&
          std::ranges::find(missing, file) == missing.end())
        missing.push_back(file);
  };
  look(values(circles_key));
  if (!points_.empty()) look(all_values().at(circles_key));
  return missing;
}

void Settings::set_points(const Points& points) {
  Points checked;
  checked.begin(points.keys);
  for (const std::vector<std::string>& row : points.rows) checked.add(row);
  if (checked.rows.empty()) throw Error("there are no points");
  points_ = std::move(checked);
}

void Settings::visit_branches(const VisitBranch& visit) const {
  Settings plain = *this;
  plain.points_ = {};
  plain.shard_ = {};
  if (points_.empty())
    visit_words(plain, [&](const Settings& branch) { visit(branch, -1); });
  else
    visit_points(plain, points_, visit);
}

std::map<std::string, std::vector<std::string>> Settings::all_values() const {
  std::map<std::string, std::vector<std::string>> all;
  std::map<std::string, std::set<std::string>> seen;
  visit_branches([&](const Settings& branch, std::int64_t) {
    for (const Key& key : keys())
      for (const std::string& value : branch.values(key.name))
        if (seen[key.name].insert(value).second) all[key.name].push_back(value);
  });
  return all;
}

/// Keys that nobody has given, and that have another text in a branch because of its words: written down as
/// given they would contradict it.
std::set<std::string> Settings::keys_that_follow() const {
  std::set<std::string> following;
  visit_branches([&](const Settings& branch, std::int64_t) {
    for (const Key& key : keys())
      if (!branch.is_given(key.name) && !is_given(key.name) && branch.text(key.name) != text(key.name))
        following.insert(key.name);
  });
  if (following.contains(layout_key))  // which a channel's keys would set
    for (const Key& key : keys())
      if (is_of_channel(key) && !is_given(key.name)) following.insert(key.name);
  return following;
}

}  // namespace clog::sweep

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

/// Whether the texts of other keys may follow from the text of this key. See Settings::resolved().
bool leads(const Key& key) {
  return key.name == "preset" || key.name == circles_key || key.name == layout_key || key.name == "release" ||
         is_of_channel(key);
}

/// The scene of a layout; nullptr for other texts, such as a list.
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
  return key.has_unit() ? std::string("in ") + key.parameter->unit : "a pure number";
}

/// Reads the list of a key, and checks that each value is possible in some run. @throws Error that names the
/// key
std::vector<std::string> values_of(const Key& key, const std::string& text) {
  constexpr std::size_t longest_text = 3000;  // longest list that a config can store
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
    throw NumberWithUnit(refused_value(key.name, text,
                                       fmt::format("{}; numbers have no unit here: this one is {}",
                                                   error.what(), unit_in_words(key))) +
                         (key.has_unit() ? "" : " leave the unit out"));
  } catch (const Error& error) {
    throw Error(refused_value(key.name, text, error.what()));
  }
}

/// Calls visit() for each combination of single words.
void visit_words(const Settings& settings, const std::function<void(const Settings&)>& visit) {
  for (const Key& key : keys()) {
    if (key.kind != ValueKind::word) continue;
    const std::vector<std::string>& words = settings.values(key.name);
    if (words.size() == 1) continue;
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
  const std::size_t place = place_of_key(name);
  const Key& key = keys()[place];
  given_[place] = std::make_shared<const Entry>(Entry{text, values_of(key, text)});
  is_resolved_ = is_resolved_ && !leads(key);
  if (is_resolved_) all_[place] = given_[place];
}

bool Settings::is_given(const std::string& name) const { return given_[place_of_key(name)] != nullptr; }

const Settings::Entry& Settings::entry(const std::string& name) const {
  return *entries()[place_of_key(name)];
}

const Settings::Entries& Settings::entries() const {
  if (is_resolved_) return all_;
  Entries now = resolved();
  all_.resize(now.size());
  for (std::size_t i = 0; i < now.size(); ++i)
    if (!all_[i] || all_[i]->text != now[i]->text) all_[i] = std::move(now[i]);
  is_resolved_ = true;
  return all_;
}

/// The given texts, the texts of other keys that follow from these, and the defaults. User-supplied circles
/// and keys of a channel set the layout. The preset sets its keys. If nothing is random, there is one seed.
Settings::Entries Settings::resolved() const {
  static const Entries defaults = [] {
    Entries entries;
    for (const Key& key : keys())
      entries.push_back(
          std::make_shared<const Entry>(Entry{key.default_text, values_of(key, key.default_text)}));
    return entries;
  }();
  Entries all = given_;
  bool has_channel = false;
  for (std::size_t i = 0; i < all.size(); ++i) {
    has_channel = has_channel || (all[i] && is_of_channel(keys()[i]));
    if (!all[i]) all[i] = defaults[i];
  }
  const auto now = [&](const char* key) -> const std::string& { return all[place_of_key(key)]->text; };
  const auto follow = [&](const char* key, const char* text) {
    if (!is_given(key))
      all[place_of_key(key)] = std::make_shared<const Entry>(Entry{text, values_of(find_key(key), text)});
  };
  for (const auto& [key, text] : preset_texts(now("preset"))) follow(key, text);
  // The preset's ratio has no meaning for other springs, or if a stiffness is given.
  const std::size_t ratio = place_of_key("perimeter-stiffness-ratio");
  if (!given_[ratio] && (now("perimeter-spring") != "rest" || now("perimeter-stiffness") != "auto"))
    all[ratio] = defaults[ratio];
  const bool has_circles = now(circles_key) != "none";
  if (has_circles)
    follow(layout_key, "file");
  else if (has_channel)
    follow(layout_key, "channel");
  const Scene* const scene = scene_in(now(layout_key));
  const bool is_wall = scene && scene->walls_from == WallsFrom::droplet;
  if (is_wall || (has_circles && now("release") == "centre")) follow("seeds", "1");
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
  if (!points_.empty())
    visit_branches([&](const Settings& branch, std::int64_t) { look(branch.values(circles_key)); });
  return missing;
}

void Settings::set_points(const Points& points) {
  Points checked = points;
  checked.begin(points.keys);
  for (const std::vector<std::string>& row : points.rows) checked.add(row);
  if (checked.rows.empty()) throw Error("there are no points");
  points_ = std::move(checked);
}

void Settings::visit_branches(const VisitBranch& visit) const {
  Settings plain = *this;
  plain.points_ = {};
  plain.shard_ = {};
  plain.entries();
  if (points_.empty())
    visit_words(plain, [&](const Settings& branch) { visit(branch, -1); });
  else
    visit_points(plain, points_, visit);
}

std::map<std::string, std::vector<std::string>> Settings::all_values() const {
  std::map<std::string, std::vector<std::string>> all;
  std::map<std::string, std::set<std::string>> seen;
  Entries last(keys().size());
  visit_branches([&](const Settings& branch, std::int64_t) {
    const Entries& now = branch.entries();
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (std::exchange(last[i], now[i]) == now[i]) continue;
      const std::string& key = keys()[i].name;
      for (const std::string& value : now[i]->values)
        if (seen[key].insert(value).second) all[key].push_back(value);
    }
  });
  return all;
}

/// Keys that are not given and that have different texts in different branches. A config must not contain
/// these keys, because a single text would contradict some branches.
std::set<std::string> Settings::keys_that_follow() const {
  std::set<std::string> following;
  visit_branches([&](const Settings& branch, std::int64_t) {
    const Entries& now = branch.entries();
    for (std::size_t i = 0; i < now.size(); ++i)
      if (!branch.given_[i] && !given_[i] && now[i] != entries()[i] && now[i]->text != entries()[i]->text)
        following.insert(keys()[i].name);
  });
  // Channel keys in a stored config would set obstacle-layout, which must follow from each branch.
  if (following.contains(layout_key))
    for (const Key& key : keys())
      if (is_of_channel(key) && !is_given(key.name)) following.insert(key.name);
  return following;
}

}  // namespace clog::sweep

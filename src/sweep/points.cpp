#include "clog/sweep/points.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <sstream>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "clog/sweep/settings.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::sweep {
namespace {

constexpr const char* point_keys_line = "point-keys";
constexpr const char* point_line = "point";
constexpr const char* shard_line = "shard";
constexpr const char* usual_text = "*";  // of a key for which a point has no text
constexpr std::size_t most_points = 100'000;

/// The text without blanks, which separate texts.
std::string word_of(const std::string& text) {
  if (text.empty()) return usual_text;
  if (text == usual_text) return "\\x2a";
  std::string word;
  for (const char c : escaped(text)) word += c == ' ' ? std::string("\\x20") : std::string(1, c);
  return word;
}

std::string line_of(const char* name, const std::vector<std::string>& texts) {
  std::string line = fmt::format("{} =", name);
  for (const std::string& text : texts) line += ' ' + word_of(text);
  return line + '\n';
}

std::string lines_of(const Points& points) {
  std::string lines = line_of(point_keys_line, points.keys);
  for (const std::vector<std::string>& row : points.rows) lines += line_of(point_line, row);
  return lines;
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

Shard Shard::from(const std::string& text) {
  const auto slash = std::min(text.find('/'), text.size());
  Shard shard{0, 0};
  try {
    shard = {to_integer(text.substr(0, slash)), to_integer(text.substr(std::min(slash + 1, text.size())))};
  } catch (const Error&) {
    // said below
  }
  if (shard.of < 1 || shard.number < 1 || shard.number > shard.of)
    throw Error("is not a part like 2/5, the second of five");
  return shard;
}

std::string Shard::text() const { return fmt::format("{}/{}", number, of); }

std::string config_lines(const Points& points, const Shard& shard) {
  std::string lines;
  if (!points.empty()) lines += lines_of(points);
  if (!shard.is_whole()) lines += fmt::format("{} = {}\n", shard_line, shard.text());
  return lines;
}

std::vector<std::string> texts_of_line(const std::string& line) {
  std::vector<std::string> texts;
  std::istringstream words(line);
  for (std::string word; words >> word;) texts.push_back(word == usual_text ? "" : unescaped(word));
  return texts;
}

bool Settings::is_plan_line(const std::string& name) {
  return name == point_keys_line || name == point_line || name == shard_line;
}

void Settings::set_line(const std::string& name, const std::string& text) {
  if (name == point_keys_line) {
    begin_points(points_, texts_of_line(text));
  } else if (name == point_line) {
    if (points_.empty())
      throw Error("a point stands before the line `point-keys = ...`, which names its keys");
    add_point(points_, texts_of_line(text));
  } else if (name == shard_line) {
    shard_ = Shard::from(text);
  } else {
    set(name, unescaped(text));
  }
}

void Settings::begin_points(Points& points, const std::vector<std::string>& keys) const {
  if (keys.empty()) throw Error("points have no keys");
  for (std::size_t i = 0; i < keys.size(); ++i) {
    find_key(keys[i]);
    if (std::find(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(i), keys[i]) !=
        keys.begin() + static_cast<std::ptrdiff_t>(i))
      throw Error(fmt::format("the key {} stands twice among those of the points", keys[i]));
  }
  points = {keys, {}};
}

void Settings::add_point(Points& points, const std::vector<std::string>& texts) const {
  if (texts.size() != points.keys.size())
    throw Error(fmt::format("a point has {} for {}",
                            counted(static_cast<std::int64_t>(texts.size()), "value"),
                            counted(static_cast<std::int64_t>(points.keys.size()), "key")));
  if (points.rows.size() == most_points)
    throw Error(fmt::format("there are more than {} points; make several sweeps of them", most_points));
  static const Settings defaults;
  Settings scratch = defaults;
  try {
    for (std::size_t i = 0; i < texts.size(); ++i)
      if (!texts[i].empty()) scratch.set(points.keys[i], texts[i]);
  } catch (const Error& error) {
    throw Error(fmt::format("point {}: {}", points.rows.size() + 1, error.what()));
  }
  points.rows.push_back(texts);
}

void Settings::set_points(const Points& points) {
  Points checked;
  begin_points(checked, points.keys);
  for (const std::vector<std::string>& row : points.rows) add_point(checked, row);
  if (checked.rows.empty()) throw Error("there are no points");
  points_ = std::move(checked);
}

Settings Settings::without_points() const {
  Settings plain = *this;
  plain.points_ = {};
  plain.shard_ = {};
  return plain;
}

void Settings::visit_branches(const VisitBranch& visit) const {
  const Settings plain = without_points();
  if (points_.empty())
    visit_words(plain, [&](const Settings& branch) { visit(branch, -1); });
  else
    visit_points(plain, points_, visit);
}

std::map<std::string, std::vector<std::string>> Settings::all_values() const {
  std::map<std::string, std::vector<std::string>> all;
  std::map<std::string, std::set<std::string>> seen;
  visit_branches([&](const Settings& branch, std::int64_t) {
    for (const auto& [name, values] : branch.values_)
      for (const std::string& value : values)
        if (seen[name].insert(value).second) all[name].push_back(value);
  });
  return all;
}

/// Keys that nobody has given, and that have another text in a branch because of its words: written down as
/// given they would contradict it.
std::set<std::string> Settings::keys_that_follow() const {
  std::set<std::string> following;
  visit_branches([&](const Settings& branch, std::int64_t) {
    for (const auto& [name, text] : branch.texts_)
      if (!branch.is_given(name) && !is_given(name) && text != texts_.at(name)) following.insert(name);
  });
  return following;
}

}  // namespace clog::sweep

#include "clog/sweep/points.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/sweep/settings.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::sweep {
namespace {

std::string in_file(const Points& points) { return points.file.empty() ? "" : points.file + ": "; }

/// @param place  place of a point that cannot be read
std::string where(const Points& points, std::size_t place) {
  if (place < points.lines.size()) return fmt::format("{} line {}: ", points.file, points.lines[place]);
  return fmt::format("{}point {}: ", in_file(points), place + 1);
}

}  // namespace

void Points::begin(const std::vector<std::string>& names) {
  if (names.empty()) throw Error("points have no keys");
  for (const std::string& name : names) {
    find_key(name);
    if (std::ranges::count(names, name) > 1)
      throw Error(fmt::format("{}the key {} stands twice among those of the points", in_file(*this), name));
  }
  keys = names;
  rows.clear();
}

void Points::add(const std::vector<std::string>& texts) {
  constexpr std::size_t most_points = 100'000;
  if (texts.size() != keys.size())
    throw Error(fmt::format("a point has {} for {}", count_text(std::ssize(texts), "value"),
                            count_text(std::ssize(keys), "key")));
  if (rows.size() == most_points)
    throw Error(fmt::format("{}there are more than {} points; make several sweeps of them", in_file(*this),
                            most_points));
  Settings scratch;
  try {
    for (std::size_t i = 0; i < texts.size(); ++i)
      if (!texts[i].empty()) scratch.set(keys[i], texts[i]);
  } catch (const Error& error) {
    throw Error(where(*this, rows.size()) + error.what());
  }
  rows.push_back(texts);
}

Shard Shard::from(const std::string& text) {
  const auto slash = std::min(text.find('/'), text.size());
  Shard shard{0, 0};
  try {
    shard = {to_integer(text.substr(0, slash)), to_integer(text.substr(std::min(slash + 1, text.size())))};
  } catch (const Error&) {
    // the code below refuses the text
  }
  if (shard.of < 1 || shard.number < 1 || shard.number > shard.of)
    throw Error("is not a part like 2/5, the second of five");
  return shard;
}

std::string Shard::text() const { return fmt::format("{}/{}", number, of); }

}  // namespace clog::sweep

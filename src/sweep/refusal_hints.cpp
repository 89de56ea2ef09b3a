#include "refusal_hints.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>

#include "clog/sweep/value_list.hpp"

namespace clog::sweep {
namespace {

bool contains(const std::vector<std::string>& all, const std::string& one) {
  return std::ranges::find(all, one) != all.end();
}

/// The refused key, if it has one text for all points; nullptr if the point sets it.
/// @param common  settings with the points
const Key* refused_for_point(const Settings& common, std::size_t point, const Refusal::About& refused) {
  const Points& points = common.points();
  for (const Key& key : keys()) {
    if (!common.is_given(key.name)) continue;
    const auto column =
        static_cast<std::size_t>(std::ranges::find(points.keys, key.name) - points.keys.begin());
    if (column < points.keys.size() && !points.rows[point][column].empty()) continue;
    if (key.name == refused.key || contains(refused.excluded, key.name)) return &key;
  }
  return nullptr;
}

}  // namespace

std::string hint_at_list(const Settings& branch, const Settings& lists, const Refusal& refusal) {
  const std::string& key = refusal.about().key;
  if (std::ranges::find(keys(), key, &Key::name) == keys().end()) return "";
  const bool is_list = branch.values(key).size() > 1;
  for (const Key& other : keys())
    if (other.name != key && refusal.names(other.name) && lists.values(other.name).size() > 1)
      return (is_list ? "; each value of a list meets all of the other"
                      : fmt::format("; it meets each value of {}", other.name)) +
             "; to pair values, see clogsweep --points";
  if (!is_list) return "";
  constexpr std::size_t most_digits = 2;  // before a comma that may be a decimal comma
  const std::string& list = branch.text(key);
  const std::string meant = with_decimal_point(list);
  return meant.find('.') <= most_digits ? fmt::format("; {} are two values: did you mean {}?", list, meant)
                                        : "";
}

std::string refusal_of_point(const Settings& common, std::size_t point, const Refusal& refusal) {
  const Points& points = common.points();
  const Key* const key = refused_for_point(common, point, refusal.about());
  if (!key || points.rows.size() == 1) return refusal.what();
  const bool has_value = contains(points.keys, refusal.about().added);
  return fmt::format("{}to give {} for some points, {}",
                     has_value ? refusal.without_remedy() + ' ' : std::string(refusal.what()) + "; ",
                     key->name,
                     contains(points.keys, key->name)
                         ? "leave it out elsewhere and write it in their cells of the points file"
                         : "make it a column of the points file, with empty cells for the others");
}

}  // namespace clog::sweep

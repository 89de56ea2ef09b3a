#include "clog/campaign/curves.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <variant>

#include "clog/campaign/usual_parameters.hpp"
#include "clog/core/parameters/schema.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/core/tools/split.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::campaign {
namespace {

constexpr std::size_t most_curve_keys = 2;

/// A number that a user chooses, and that shapes what happens: not one that follows from others.
bool may_be_key(const sweep::Column& column, std::span<const Group> groups) {
  if (!column.parameter || column.parameter->role != ParameterRole::physics) return false;
  return std::ranges::all_of(groups, [&](const Group& group) {
    return std::holds_alternative<double>(column.get(group.first_row)) &&
           !is_automatic(column, group.first_row);
  });
}

std::set<double> different_values(const sweep::Column& column, std::span<const Group> groups) {
  std::set<double> values;
  for (const Group& group : groups)
    if (const Value value = column.get(group.first_row); std::holds_alternative<double>(value))
      values.insert(std::get<double>(value));
  return values;
}

CurveKeys varying_keys(std::span<const Group> groups) {
  CurveKeys keys;
  for (const sweep::Column* column : group_columns())
    if (may_be_key(*column, groups) && different_values(*column, groups).size() > 1) keys.push_back(column);
  return keys;
}

std::string names_of(const CurveKeys& keys) {
  std::vector<std::string> names;
  for (const sweep::Column* key : keys) names.emplace_back(key->parameter->key);
  return joined(names, ", ");
}

const sweep::Column* named_key(const std::string& name, std::span<const Group> groups) {
  std::string key = name;
  std::ranges::replace(key, '_', '-');
  const Parameter* parameter = sweep::find_key(key).parameter;
  for (const sweep::Column* column : group_columns())
    if (parameter && column->parameter == parameter && may_be_key(*column, groups)) return column;
  throw Error(fmt::format("invalid --key={} (is not a number of the physics that the sweep gives)", name));
}

void require_logarithms(const CurveKeys& keys, std::span<const Group> groups) {
  for (const sweep::Column* key : keys) {
    const std::set<double> values = different_values(*key, groups);
    if (values.size() < 2)
      throw Error(fmt::format("invalid --key={} (all runs have the same value of it)", key->parameter->key));
    if (!(*values.begin() > 0))
      throw Error(
          fmt::format("cannot fit a curve over {} (it has the value {}, of which there is no logarithm)",
                      key->parameter->key, shortest(*values.begin())));
  }
}

/// Evenly on a logarithmic scale between the outermost values of each key.
std::vector<fit::CurvePlace> grid_over(std::span<const fit::CurvePoint> points, std::size_t num_keys) {
  constexpr int num_on_a_line = 97;  // over two decades, a step is 5 %
  constexpr int num_on_a_side = 25;
  Eigen::Array2d low = points.front().place;
  Eigen::Array2d high = low;
  for (const fit::CurvePoint& point : points) {
    low = low.min(point.place.array());
    high = high.max(point.place.array());
  }
  const int number = num_keys == 1 ? num_on_a_line : num_on_a_side;
  const auto at = [&](int key, int i) {
    const double share = static_cast<double>(i) / (number - 1);
    return (1 - share) * low[key] + share * high[key];
  };
  std::vector<fit::CurvePlace> places;
  for (int j = 0; j < (num_keys == 1 ? 1 : number); ++j)
    for (int i = 0; i < number; ++i) places.emplace_back(at(0, i), num_keys == 1 ? low[1] : at(1, j));
  return places;
}

std::vector<fit::CurvePoint> points_of(std::span<const Group> groups, const std::vector<std::size_t>& members,
                                       const CurveKeys& keys) {
  std::vector<fit::CurvePoint> points;
  for (const std::size_t index : members) {
    const Group& group = groups[index];
    points.push_back({curve_place(group, keys), static_cast<double>(group.clogging.num_clogs),
                      group.clogging.total_distance});
  }
  return points;
}

std::vector<CurveByCause> curves_by_cause(std::span<const Group> groups, const FittedCurve& curve,
                                          std::vector<fit::CurvePoint> points, double confidence) {
  std::vector<CurveByCause> all;
  if (std::ranges::any_of(curve.groups, [&](std::size_t index) { return groups[index].causes.empty(); }))
    return all;
  for (std::size_t cause = 0; cause < std::size(cause_texts); ++cause) {
    double num_clogs = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      num_clogs += points[i].num_clogs = groups[curve.groups[i]].causes[cause].ends.num_clogs;
    if (num_clogs > 0)
      all.push_back({&cause_texts[cause], num_clogs,
                     fit::curve_values(fit::fit_curve(points, curve.places), confidence)});
  }
  return all;
}

/// Whether points share seeds, and the obstacles follow from the seed alone: no key shapes the array.
bool have_common_obstacles(std::span<const Group> groups, const std::vector<std::size_t>& members,
                           const CurveKeys& keys) {
  if (std::ranges::any_of(keys, &sweep::Column::shapes_array)) return false;
  std::set<std::uint32_t> seen;
  for (const std::size_t index : members) {
    const std::set<std::uint32_t> seeds(groups[index].seeds.begin(), groups[index].seeds.end());
    for (const std::uint32_t seed : seeds)
      if (!seen.insert(seed).second) return true;
  }
  return false;
}

/// Has it two values of each key, as a line or a surface must?
bool spans_keys(std::span<const fit::CurvePoint> points, std::size_t num_keys) {
  for (std::size_t key = 0; key < num_keys; ++key) {
    const auto index = static_cast<Eigen::Index>(key);
    if (std::ranges::all_of(points, [&](const fit::CurvePoint& point) {
          return point.place[index] == points.front().place[index];
        }))
      return false;
  }
  return true;
}

}  // namespace

CurveKeys curve_keys(std::span<const Group> groups, const std::string& names) {
  if (names.empty()) {
    CurveKeys keys = varying_keys(groups);
    if (keys.empty())
      throw Error("cannot fit a curve (no number of the physics has several values); give the sweep a list");
    if (keys.size() > 1)
      throw Error(fmt::format("no --key is given, and several vary ({}); try --key {}", names_of(keys),
                              keys.front()->parameter->key));
    require_logarithms(keys, groups);
    return keys;
  }
  CurveKeys keys;
  for (const std::string& name : split_at_commas(names)) keys.push_back(named_key(name, groups));
  if (keys.size() > most_curve_keys || (keys.size() == most_curve_keys && keys[0] == keys[1]))
    throw Error(
        fmt::format("invalid --key={} (a curve is drawn over one key, or over two different ones)", names));
  require_logarithms(keys, groups);
  return keys;
}

fit::CurvePlace curve_place(const Group& group, const CurveKeys& keys) {
  fit::CurvePlace place = fit::CurvePlace::Zero();
  for (std::size_t i = 0; i < keys.size(); ++i)
    place[static_cast<Eigen::Index>(i)] = std::log(std::get<double>(keys[i]->get(group.first_row)));
  return place;
}

std::vector<FittedCurve> fit_curves(std::span<const Group> groups, const CurveQuestion& question) {
  std::map<std::vector<Field>, std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (!(groups[i].clogging.total_distance > 0)) continue;
    std::vector<Field> others;
    for (const sweep::Column* column : group_columns())
      if (std::ranges::find(question.keys, column) == question.keys.end())
        others.emplace_back(column->name.c_str(), separating_value(*column, groups[i].first_row));
    members[std::move(others)].push_back(i);
  }
  std::vector<FittedCurve> curves;
  for (auto& [shared, indices] : members) {
    std::ranges::sort(indices, {}, [&](std::size_t index) {
      const fit::CurvePlace place = curve_place(groups[index], question.keys);
      return std::pair(place[1], place[0]);
    });
    const std::vector<fit::CurvePoint> points = points_of(groups, indices, question.keys);
    if (!spans_keys(points, question.keys.size())) continue;
    FittedCurve curve;
    curve.groups = indices;
    curve.shared = shared;
    curve.places = grid_over(points, question.keys.size());
    const fit::Curve fitted = fit::fit_curve(points, curve.places);
    curve.values = fit::curve_values(fitted, question.confidence);
    curve.peak = fit::find_peak(fitted, curve.places, question.confidence);
    for (const double length : question.crossed_lengths)
      curve.crossings.push_back(fit::find_crossings(fitted, curve.places, length, question.confidence));
    curve.causes = curves_by_cause(groups, curve, points, question.confidence);
    curve.has_common_obstacles = have_common_obstacles(groups, indices, question.keys);
    curves.push_back(std::move(curve));
  }
  if (curves.empty())
    throw Error(
        fmt::format("cannot fit a curve over {} (no set of the other parameters has two of its values)",
                    names_of(question.keys)));
  // Removes the fields that all curves share.
  for (std::size_t i = curves.front().shared.size(); i-- > 0;)
    if (std::ranges::all_of(curves, [&](const FittedCurve& curve) {
          return curve.shared.size() == curves.front().shared.size() &&
                 curve.shared[i] == curves.front().shared[i];
        }))
      for (FittedCurve& curve : curves)
        curve.shared.erase(curve.shared.begin() + static_cast<std::ptrdiff_t>(i));
  return curves;
}

}  // namespace clog::campaign

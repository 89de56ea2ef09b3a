#include "clog/campaign/angle_search.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>

#include "clog/campaign/groups.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/core/world/lattice.hpp"
#include "clog/sweep/columns.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/row_check.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::campaign {
namespace {

constexpr const char* angle_key = "lattice-angle";
constexpr double degree = std::numbers::pi / 180;
constexpr double same_angle = 1e-9;  // [degrees]: equal ones differ by rounding only

double spacing_of(const ObstacleParameters& obstacles) { return obstacles.diameter + obstacles.gap; }

/// Values of the key's list, in increasing order. @throws Error unless there are two between 0 and 45 degrees
std::vector<double> angle_bounds(const sweep::Settings& settings) {
  constexpr double largest = 45;  // a square lattice has no others, by symmetry
  const auto refuse = [&](const std::string& why) {
    throw Error(fmt::format("invalid {0}={1} ({2}) try {0}=5,40", angle_key, settings.text(angle_key), why));
  };
  std::vector<double> angles;
  for (const std::string& text : settings.values(angle_key)) angles.push_back(sweep::to_number(text));
  if (angles.size() < 2) refuse("--refine lattice-angle needs its bounds");
  if (std::ranges::adjacent_find(angles, std::ranges::greater_equal()) != angles.end())
    refuse("with --refine values increase: the lower bound comes first");
  if (!(angles.front() > 0 && angles.back() <= largest))
    refuse("the critical angle lies above 0, where droplets follow the rows by symmetry, up to 45 degrees");
  return angles;
}

/// As few decimals as mean this lattice.
std::string text_of_angle(ObstacleParameters obstacles, double angle) {
  constexpr int most_decimals = 6;
  for (int decimals = 2; decimals <= most_decimals; ++decimals) {
    const std::string text = fmt::format("{:.{}f}", angle, decimals);
    obstacles.lattice_angle = sweep::to_number(text);
    const auto lattice = fitting_lattice(obstacles);
    if (lattice && std::abs(lattice->angle - angle) <= same_angle) return shortest(obstacles.lattice_angle);
  }
  return shortest(angle);
}

std::string in_degrees(double angle) { return fmt::format("{:.4g}", angle); }

}  // namespace

void count_run(TriedAngle& angle, double along, double across, double spacing) {
  constexpr double most_off = 1;     // rows that a droplet may come off and still follow them
  constexpr double fewest_rows = 2;  // that a way along the flow must cross for a run to count
  const double sine = std::sin(angle.angle * degree);
  const double rows_off = std::abs(across * std::cos(angle.angle * degree) - along * sine) / spacing;
  if (rows_off > most_off)
    ++angle.num_leaving;
  else if (along * sine >= fewest_rows * spacing)
    ++angle.num_following;
  else
    ++angle.num_short;
}

AngleBracket critical_bracket(std::span<const TriedAngle> angles) {
  AngleBracket bracket;
  for (const TriedAngle& one : angles) {
    if (one.leaves()) {
      bracket.upper = one.angle;
      break;
    }
    if (one.follows()) bracket.lower = one.angle;
  }
  return bracket;
}

/// What is known at one moment.
struct AngleSearch::Look {
  std::vector<TriedAngle> angles;  ///< in increasing order
  AngleBracket bracket;
  double seconds = 0;
};

AngleSearch::AngleSearch(const sweep::Settings& settings, Options options)
    : options_(options), first_(settings), seeds_(settings.text("seeds")) {
  require_one_value_of_others(settings, std::vector<std::string>{angle_key});
  const std::vector<double> given = angle_bounds(settings);
  lowest_ = given.front();
  highest_ = given.back();
  const sweep::Plan plan(settings);  // refuses angles that do not fit
  usual_ = plan.task(0);
  obstacles_ = usual_.obstacles;
  obstacles_.box = sweep::to_number(settings.values("box").front());
  std::vector<std::string> angles = settings.values(angle_key);
  if (given.size() == 2) {
    const std::vector<std::string> inner = angles_within({lowest_, highest_}, given);
    angles.insert(angles.begin() + 1, inner.begin(), inner.end());
  }
  first_.set_points(points_of(angles));
}

sweep::Points AngleSearch::points_of(const std::vector<std::string>& angles) const {
  sweep::Points points{{angle_key, "seeds"}, {}};
  for (const std::string& angle : angles) points.rows.push_back({angle, seeds_});
  return points;
}

/// Up to three, at the quarters of the bracket, which no run has tried.
std::vector<std::string> AngleSearch::angles_within(const AngleBracket& bracket,
                                                    std::span<const double> tried) const {
  constexpr int parts = 4;
  std::vector<double> known(tried.begin(), tried.end());
  std::map<double, std::string> found;
  for (int part = 1; part < parts; ++part) {
    ObstacleParameters obstacles = obstacles_;
    obstacles.lattice_angle = bracket.lower + part * (bracket.upper - bracket.lower) / parts;
    const auto lattice = nearest_lattice(obstacles);
    if (!lattice || lattice->angle <= bracket.lower || lattice->angle >= bracket.upper) continue;
    if (std::ranges::any_of(known,
                            [&](double angle) { return std::abs(angle - lattice->angle) <= same_angle; }))
      continue;
    known.push_back(lattice->angle);
    found.emplace(lattice->angle, text_of_angle(obstacles_, lattice->angle));
  }
  std::vector<std::string> texts;
  texts.reserve(found.size());
  for (const auto& [angle, text] : found) texts.push_back(text);
  return texts;
}

AngleSearch::Look AngleSearch::look(std::span<const sweep::RunRow> rows) const {
  const sweep::RunRow usual_row = sweep::describe(usual_);
  // The box of a lattice is one of its periods: it follows from the angle and means nothing to the droplet.
  const auto is_of_search = [&](const sweep::RunRow& row) {
    return std::ranges::all_of(group_columns(), [&](const sweep::Column* column) {
      return column->name == "lattice_angle" || column->name == "box" || column->may_be_automatic(usual_) ||
             column->get(row) == column->get(usual_row);
    });
  };
  Look found;
  std::map<double, TriedAngle> angles;
  for (const sweep::RunRow& row : rows) {
    if (!is_of_search(row) || !sweep::fault_of(row).empty() || sweep::is_unfinished(row.status)) continue;
    found.seconds += sweep::cost_seconds(row);
    const double angle = row.parameters.obstacles.lattice_angle;
    TriedAngle& here = angles[angle];
    here.angle = angle;
    if (row.status == RunStatus::failed)
      ++here.num_short;
    else
      count_run(here, row.distance, row.lateral_displacement, spacing_of(obstacles_));
  }
  for (const auto& [angle, tried] : angles) found.angles.push_back(tried);
  found.bracket = critical_bracket(found.angles);
  return found;
}

std::optional<sweep::Points> AngleSearch::next_round(std::span<const sweep::RunRow> rows) {
  const Look now = look(rows);
  const double width = now.bracket.upper - now.bracket.lower;
  if (std::isnan(width)) {
    end_ = "the angles do not bracket it";
    return std::nullopt;
  }
  if (width <= options_.width) {
    end_ = fmt::format("critical-angle={} is reached", shortest(options_.width));
    return std::nullopt;
  }
  if (now.seconds >= options_.budget) {
    end_ = "the budget is used up";
    return std::nullopt;
  }
  std::vector<double> tried;
  for (const TriedAngle& one : now.angles) tried.push_back(one.angle);
  const std::vector<std::string> angles = angles_within(now.bracket, tried);
  if (angles.empty()) {
    end_ = fmt::format("no other lattice in between has a period of box={} or less; a larger box has more",
                       shortest(obstacles_.box));
    return std::nullopt;
  }
  return points_of(angles);
}

std::string AngleSearch::text() const {
  const std::string width =
      options_.width > 0 ? fmt::format("critical-angle={}", shortest(options_.width)) : "";
  return fmt::format(
      "angles are added, in rounds of up to three, between the last one at which all droplets follow the "
      "rows of the lattice and the first at which some leave them, until {}",
      goal_or_budget(width, options_.budget));
}

std::vector<std::string> AngleSearch::rounds_in_words(double seconds_per_run) const {
  std::vector<std::string> words = {
      "this is the first round; each of the others has up to three angles where droplets begin to leave the "
      "rows"};
  if (std::isfinite(options_.budget))
    words.push_back(
        fmt::format("all rounds: about {:.2g} core-hours at most (--budget)", options_.budget / hour));
  if (!(options_.width > 0)) return words;
  const auto num_first = static_cast<double>(first_.points().rows.size());
  const double bracket = (highest_ - lowest_) / (num_first - 1);
  const double num_rounds = std::max(0.0, std::ceil(std::log(bracket / options_.width) / std::log(4.0)));
  const double num_runs = 3 * num_rounds * static_cast<double>(first_.values("seeds").size());
  words.push_back(
      fmt::format("critical-angle={} takes about {:.0f} more rounds, {:.0f} runs: {:.2g} core-hours",
                  shortest(options_.width), num_rounds, num_runs, num_runs * seconds_per_run / hour));
  return words;
}

std::string AngleSearch::known(std::span<const sweep::RunRow> rows) const {
  const Look now = look(rows);
  std::string text = end_.empty() ? "" : end_ + "; ";
  const double lower = now.bracket.lower, upper = now.bracket.upper;
  const auto at_angles = [&](const auto& belongs) {
    std::string names;
    for (const TriedAngle& one : now.angles)
      if (belongs(one)) names += (names.empty() ? "" : ", ") + in_degrees(one.angle);
    return names;
  };
  if (std::isnan(lower) && std::isnan(upper))
    text += "no droplet went far enough to say (the flow has to cross two rows); try a larger max-time";
  else if (std::isnan(upper))
    text += fmt::format("up to {} degrees droplets follow the rows; try larger angles", in_degrees(lower));
  else if (std::isnan(lower))
    text += fmt::format("at {} degrees droplets leave the rows; try smaller angles, or a larger max-time",
                        in_degrees(upper));
  else
    text += fmt::format(
        "the critical angle is {} degrees ({} to {}): droplets follow the rows at {} and leave them at {}",
        in_degrees((lower + upper) / 2), in_degrees(lower), in_degrees(upper), in_degrees(lower),
        in_degrees(upper));
  const std::string again =
      at_angles([&](const TriedAngle& one) { return one.follows() && one.angle > upper; });
  if (!again.empty()) text += "; they follow them again at " + again;
  const std::string unknown =
      at_angles([](const TriedAngle& one) { return !one.follows() && !one.leaves(); });
  if (!unknown.empty())
    text += "; runs were too short to say at " + unknown + " (max-time, clogs or failures)";
  return text;
}

}  // namespace clog::campaign

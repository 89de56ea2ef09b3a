#include "clog/sweep/row_limits.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string_view>
#include <tuple>

#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/core/tools/portable_math.hpp"
#include "clog/core/tools/units.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/core/world/bare_stretch.hpp"

namespace clog::sweep {
namespace {

// docs/explanation/trust.md has the same limits.
constexpr double largest_tension = 10;
constexpr int fewest_vertices = 64;
constexpr int most_vertices = 1024;
constexpr double most_friction = 0.5;
constexpr double most_traction = 0.1;
constexpr double smallest_receding_angle = 60;  // [degrees]
struct SoundPreset {
  std::string_view name;
  double smallest_tension;
};
constexpr SoundPreset sound_presets[] = {{"robust", 0.05}, {"heavy-interface", 0.1}, {"elastic", 0.04}};

std::string untested_tension(const std::string& preset_name, const DpParameters& dp) {
  const auto* preset = std::find_if(std::begin(sound_presets), std::end(sound_presets),
                                    [&](const SoundPreset& one) { return one.name == preset_name; });
  if (preset == std::end(sound_presets))
    return "preset=" + preset_name +
           (preset_name == "custom" ? " (this interface was not tested)"
                                    : " (droplets cross themselves and obstacles)");
  if (dp.line_tension >= preset->smallest_tension && dp.line_tension <= largest_tension) return "";
  return fmt::format("line-tension={} ({} is tested from {} to {})", shortest(dp.line_tension), preset->name,
                     shortest(preset->smallest_tension), shortest(largest_tension));
}

std::string untested_vertices(const DpParameters& dp) {
  if (*dp.vertices >= fewest_vertices && *dp.vertices <= most_vertices) return "";
  return fmt::format("vertices={} (tested from {} to {})", *dp.vertices, fewest_vertices, most_vertices);
}

/// @param hold  friction coefficient or yield traction of walls
std::string untested_hold(const char* key, double hold, double most, const char* unit) {
  if (hold <= most) return "";
  return fmt::format("{}={} (tested up to {}{})", key, shortest(hold), shortest(most), unit);
}

std::string untested_angle(const DpParameters& dp) {
  if (!dp.receding_angle || *dp.receding_angle >= smallest_receding_angle) return "";
  return fmt::format("receding-angle={} (tested from {} on)", shortest(*dp.receding_angle),
                     shortest(smallest_receding_angle));
}

/// Very thin obstacles slip through the interface. The droplet then encloses them, at its release or later.
/// This was observed with obstacles that were not thicker than the length of an edge. It becomes more
/// frequent with the number of obstacles.
std::string untested_diameter(const RunParameters& run) {
  constexpr double thinnest = 2;  // diameter in units of the edge length, with a margin
  if (scene_of(run).walls_from == WallsFrom::droplet) return "";  // there are no obstacles
  const double edge = units::regular_edge_length(*run.dp.vertices);
  if (!(run.obstacles.smallest_diameter() < thinnest * edge)) return "";
  return fmt::format(
      "obstacle-diameter={} (obstacles thinner than two edges, {:.4g}, slip into the droplet; use more "
      "vertices)",
      shortest(run.obstacles.diameter), thinnest * edge);
}

}  // namespace

std::vector<std::string> untested_parameters(const RunRow& row) {
  std::vector<std::string> all;
  if (row.parameters.model != Model::dp) return all;
  const DpParameters& dp = row.parameters.dp;
  for (const std::string& one :
       {untested_tension(row.preset, dp), untested_vertices(dp), untested_diameter(row.parameters),
        untested_angle(dp), untested_hold("friction", dp.friction, most_friction, ""),
        untested_hold("yield-traction", dp.yield_traction, most_traction, " g rho sigma")})
    if (!one.empty()) all.push_back(one);
  return all;
}

std::string untested_parameters(const Plan& plan) {
  std::vector<std::string> all;
  for (std::int64_t group = 0; group < plan.num_groups(); ++group)
    for (const std::string& one : untested_parameters(describe(plan.group(group))))
      if (std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
  if (all.empty()) return "";
  constexpr std::size_t most_named = 4;
  if (all.size() > most_named) {
    const std::string others = fmt::format("and {} more", all.size() - most_named);
    all.resize(most_named);
    all.push_back(others);
  }
  return "outside the range tested for soundness (handbook, How far to trust it): " + joined(all);
}

double repetition_length(const RunRow& row) {
  const ObstacleParameters& obstacles = row.parameters.obstacles;
  const bool has_end = !scene_of(row.parameters).is_random || obstacles.exit > 0;
  return has_end ? std::numeric_limits<double>::infinity() : obstacles.period().along();
}

bool has_met_repetition(const RunRow& row) { return row.distance > repetition_length(row); }

/// Suggests an array of this length. It may be narrow, because one droplet needs no width, and wide arrays
/// take long to make (docs/notes/2026-11-22-long-arrays.md).
std::string enough_boxes(double length, double box) {
  constexpr double narrow = 45, too_wide = 100;
  std::string text = fmt::format("boxes={:.4g} is long enough", std::ceil(length / box));
  if (box > too_wide)
    text += fmt::format("; box={:g} boxes={:.4g} is, too, and takes less time and memory", narrow,
                        std::ceil(length / narrow));
  return text;
}

std::string possible_repetition(const Plan& plan) {
  std::int64_t num_groups = 0;
  double farthest = 0, shortest_length = 0,
         most_boxes = 0;    // numbers of the parameter set that needs the largest number of boxes
  bool is_of_user = false;  // whether the set's circles are user-supplied; boxes do not multiply such circles
  for (std::int64_t group = 0; group < plan.num_groups(); ++group) {
    const RunRow row = describe(plan.group(group));
    const RunParameters& run = row.parameters;
    const double way = run.drag.terminal_speed * run.max_time;
    if (way <= repetition_length(row)) continue;
    ++num_groups;
    if (way / run.obstacles.box <= most_boxes) continue;
    farthest = way;
    shortest_length = repetition_length(row);
    most_boxes = way / run.obstacles.box;
    is_of_user = scene_of(run).walls_from == WallsFrom::circles;
  }
  if (num_groups == 0) return "";
  return fmt::format(
      "droplets of {} of {} may travel farther than the length of their array and meet the same obstacles "
      "again: terminal-speed*max-time is up to {:.4g}, boxes*box {:.4g}; {}",
      num_groups, count_text(plan.num_groups(), "parameter set"), farthest, shortest_length,
      is_of_user ? "give a file of circles that is as long, or a shorter max-time"
                 : enough_boxes(farthest, farthest / most_boxes));
}

std::string text_of(const Stretch& stretch) {
  return fmt::format("{:.4g} to {:.4g}", stretch.begin, stretch.end);
}

std::string bare_band(std::span<const Obstacle> circles, const ObstacleParameters& obstacles) {
  const double period = obstacles.period().along();
  const auto bare = conspicuous_bare_stretch(circles, &Obstacle::x, period);
  if (!bare) return "";
  return fmt::format(
      "obstacles={} leaves x={} bare, before the array repeats at {}={}: droplets sink freely there; if that "
      "is not meant, give {}",
      obstacles.own->source(), text_of(*bare), obstacles.length > 0 ? "length" : "boxes*box",
      shortest(period), obstacles.length > 0 ? "a smaller length" : "fewer boxes or a smaller box");
}

std::string bare_lanes(std::span<const Obstacle> circles, const ObstacleParameters& obstacles) {
  constexpr std::size_t most_named = 4;
  const double period = obstacles.period().across();
  const std::vector<Stretch> lanes = clog::bare_lanes(circles, period);
  if (lanes.empty()) return "";
  std::vector<std::string> named;
  for (const Stretch& lane : lanes)
    if (named.size() < most_named) named.push_back(text_of(lane));
  if (lanes.size() > most_named) named.push_back(fmt::format("and {} more", lanes.size() - most_named));
  return fmt::format(
      "obstacles={} leaves y={} bare, wider than a droplet; the array repeats at box={}: droplets sink there "
      "and touch nothing (n); if that is not meant, give a smaller box",
      obstacles.own->source(), joined(named), shortest(period));
}

/// Warns if the circles cover only a small part of the device. The lengths of the device and the circles are
/// then probably in different units.
std::string small_part(std::span<const Obstacle> circles, const ObstacleParameters& obstacles) {
  constexpr double small = 0.2;
  const auto [left, right] = std::ranges::minmax(circles, {}, &Obstacle::x);
  const auto [lowest, highest] = std::ranges::minmax(circles, {}, &Obstacle::y);
  const double along = obstacles.period().along();
  if (right.x - left.x > small * along && highest.y - lowest.y > small * obstacles.box) return "";
  return fmt::format(
      "obstacles={} has all circles at x={:.4g} to {:.4g}, y={:.4g} to {:.4g}, a small part of {:.4g} by "
      "{:.4g} in droplet diameters; check box, length, entrance and exit (without a unit, they are in "
      "droplet "
      "diameters)",
      obstacles.own->source(), left.x, right.x, lowest.y, highest.y, along, obstacles.box);
}

/// One line for each file of circles without diameters, unless the user gave obstacle-diameter. Users easily
/// overlook the default diameter.
std::vector<std::string> missing_diameters(const Plan& plan) {
  std::map<std::string, std::string> lines;
  for (std::int64_t group = 0; group < plan.num_groups(); ++group) {
    const RunParameters run = plan.group(group);
    if (scene_of(run).walls_from != WallsFrom::circles) continue;
    if (run.obstacles.diameter != ObstacleParameters().diameter) return {};
    const OwnCircles& own = *run.obstacles.own;
    if (const auto number = std::ranges::count(own.circles(), 0.0, &Obstacle::radius); number > 0)
      lines[own.check_sum()] = fmt::format(
          "obstacles={} gives no diameter for {}; obstacle-diameter={} is used for {}", own.source(),
          count_text(number, "circle"), shortest(run.obstacles.diameter), number == 1 ? "it" : "them");
  }
  std::vector<std::string> all;
  all.reserve(lines.size());
  for (auto& [check_sum, line] : lines) all.push_back(std::move(line));
  return all;
}

std::vector<std::string> limits_of_circles(const Plan& plan) {
  if (plan.circle_files().empty()) return {};
  std::vector<std::string> all = missing_diameters(plan);
  std::set<std::tuple<std::string, double, double>> seen;
  for (std::int64_t group = 0; group < plan.num_groups(); ++group) {
    const RunParameters run = plan.group(group);
    const ObstacleParameters& obstacles = run.obstacles;
    if (scene_of(run).walls_from != WallsFrom::circles) continue;
    if (!seen.emplace(obstacles.own->check_sum(), obstacles.box, obstacles.period().along()).second) continue;
    const std::vector<Obstacle> circles = obstacles.own->with_radii(obstacles.diameter / 2);
    // A bare band before an exit, or a bare lane between walls, is intended.
    if (obstacles.exit == 0) all.push_back(bare_band(circles, obstacles));
    if (obstacles.side_walls == SideWalls::off) all.push_back(bare_lanes(circles, obstacles));
    if (obstacles.exit > 0 || obstacles.side_walls == SideWalls::on)
      all.push_back(small_part(circles, obstacles));
  }
  std::erase(all, "");
  return all;
}

double weight_borne_by_friction(const DpParameters& dp) {
  if (dp.film_friction != FilmFriction::on) return 0;
  const double tension_ratio = portable::exp(std::numbers::pi * dp.friction);
  return (tension_ratio - 1) / (tension_ratio + 1);
}

std::vector<std::string> limits_of_results(const Plan& plan) {
  std::vector<std::string> all = plan.possible_decimals();
  all.push_back(possible_repetition(plan));
  all.push_back(untested_parameters(plan));
  for (const std::string& words : limits_of_circles(plan)) all.push_back(words);
  std::erase(all, "");
  return all;
}

bool may_hang_on_mesh(const RunRow& row) {
  if (row.status != RunStatus::clogged || row.parameters.model != Model::dp) return false;
  const DpParameters& dp = row.parameters.dp;
  const bool hangs =
      row.hold.mechanism == ClogMechanism::wrapped || row.hold.mechanism == ClogMechanism::hybrid;
  if (!is_known(row.hold.geometry.mesh_hold)) return hangs;
  if (dp.friction > 0 && dp.film_friction == FilmFriction::off && hangs) return true;
  return row.hold.geometry.mesh_hold > std::max(tolerated_mesh_hold, weight_borne_by_friction(dp));
}

bool is_near_friction_limit(const RunRow& row) {
  return row.hold.friction_use > tolerated_friction_use && row.hold.friction_use < arrested_friction_use;
}

double obstacle_spacing(const RunRow& row) {
  const bool is_of_user = scene_of(row.parameters).walls_from == WallsFrom::circles;
  if (is_of_user && row.obstacle_density > 0) return 1 / std::sqrt(row.obstacle_density);
  return row.parameters.obstacles.diameter + row.parameters.obstacles.gap;
}

}  // namespace clog::sweep

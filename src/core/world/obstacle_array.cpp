#include "clog/core/world/obstacle_array.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/units.hpp"

namespace clog {
namespace {

double wrapped(double value, double period) {
  if (value >= 0 && value < period) return value;
  const double inside = value - period * std::floor(value / period);
  return inside < period ? inside : 0.0;  // a tiny negative value rounds up to the period itself
}

int num_cells_in(double edge) { return std::max(1, static_cast<int>(edge / units::droplet_diameter)); }

/// Cells along one edge of a period.
struct CellAxis {
  double edge;       ///< length of one box, or of the whole period [sigma]
  int num_per_edge;  ///< number of cells along this length
  int number;        ///< number of cells in the period

  /// Index of the cell at a place, which may be outside the period. The limits keep the index of a diverged
  /// droplet within the range of int.
  int index(double place) const {
    return static_cast<int>(std::floor(std::clamp(place * (num_per_edge / edge), -1e9, 1e9)));
  }
  int index_within(double place) const {
    return std::min(static_cast<int>(place / edge * num_per_edge), number - 1);
  }
};

CellAxis columns_of(const Period& period) {
  if (period.length > 0) return {period.length, num_cells_in(period.length), num_cells_in(period.length)};
  return {period.box, num_cells_in(period.box), period.boxes * num_cells_in(period.box)};
}

CellAxis rows_of(const Period& period) {
  return {period.across(), num_cells_in(period.across()), num_cells_in(period.across())};
}

/// Whether one of two circles has its centre within the other. Circles with the same centre do not count,
/// because they are either a mistake or a circle and its own image.
bool share_a_post(double apart, double first_radius, double second_radius) {
  return apart > 0 && apart < std::max(first_radius, second_radius);
}

/// 1 if a straight line crosses the positive x axis upwards, -1 if it crosses the axis downwards, otherwise
/// 0. The sum over a closed path is the number of the path's turns about the origin.
int crossings_of_axis(const Eigen::Array2d& from, const Eigen::Array2d& to) {
  if ((from[1] < 0) == (to[1] < 0)) return 0;
  const double x = from[0] - from[1] * (to[0] - from[0]) / (to[1] - from[1]);
  if (x <= 0) return 0;
  return to[1] < 0 ? -1 : 1;
}

}  // namespace

ObstacleArray::ObstacleArray(const Period& period, std::vector<Obstacle> obstacles, std::vector<Wedge> wedges)
    : wedges_(std::move(wedges)) {
  assert(std::ranges::all_of(wedges_, [](const Wedge& wedge) {
    return wedge.half_angle.cos >= 0 && wedge.half_angle.sin > 0 &&
           std::abs(wedge.axis.matrix().norm() - 1) < 1e-9;
  }));
  binned_.period = period;
  for (Obstacle& obstacle : obstacles) {
    if (!(obstacle.radius > 0) || !std::isfinite(obstacle.radius) || !std::isfinite(obstacle.x) ||
        !std::isfinite(obstacle.y))
      throw Error(
          fmt::format("invalid obstacle at x={:.6g}, y={:.6g} with diameter {:.6g} (must be finite, the "
                      "diameter positive)",
                      obstacle.x, obstacle.y, 2 * obstacle.radius));
    obstacle.x = wrapped(obstacle.x, period.along());
    obstacle.y = wrapped(obstacle.y, period.across());
    binned_.largest_radius = std::max(binned_.largest_radius, obstacle.radius);
  }
  struct Memory {
    std::vector<Obstacle> obstacles;
    std::vector<std::uint32_t> cell_start;
  };
  auto memory = std::make_shared<Memory>();
  memory->cell_start = bin(obstacles);
  memory->obstacles = std::move(obstacles);
  binned_.obstacles = memory->obstacles;
  binned_.cell_start = memory->cell_start;
  memory_ = std::move(memory);
}

ObstacleArray::ObstacleArray(const BinnedObstacles& binned, std::shared_ptr<const void> memory)
    : binned_(binned), memory_(std::move(memory)) {
  assert(binned.cell_start.size() == num_cells(binned.period) + 1);
  assert(binned.cell_start.back() == binned.obstacles.size());
}

std::size_t ObstacleArray::num_cells(const Period& period) {
  return static_cast<std::size_t>(columns_of(period).number) * rows_of(period).number;
}

std::uint32_t ObstacleArray::cell_of(double x, double y) const {
  const CellAxis columns = columns_of(period());
  return static_cast<std::uint32_t>(rows_of(period()).index_within(y)) * columns.number +
         columns.index_within(x);
}

std::vector<std::uint32_t> ObstacleArray::bin(std::vector<Obstacle>& obstacles) const {
  std::vector<std::uint32_t> cell_start(num_cells(period()) + 1, 0);
  std::vector<std::uint32_t> target(obstacles.size());
  for (std::size_t i = 0; i < target.size(); ++i) {
    target[i] = cell_of(obstacles[i].x, obstacles[i].y);
    ++cell_start[target[i] + 1];
  }
  std::partial_sum(cell_start.begin(), cell_start.end(), cell_start.begin());
  std::vector<std::uint32_t> next(cell_start.begin(), cell_start.end() - 1);
  for (std::uint32_t& place : target) place = next[place]++;
  // Sorts in place, because a second copy would be most of the memory that building an array needs.
  for (std::size_t i = 0; i < target.size(); ++i)
    while (target[i] != i) {
      const std::uint32_t place = target[i];
      std::swap(obstacles[i], obstacles[place]);
      std::swap(target[i], target[place]);
    }
  return cell_start;
}

template <class Visit>
void ObstacleArray::visit_window(const Window& window, Visit visit) const {
  const double reach = window.margin + binned_.largest_radius;
  const CellAxis columns = columns_of(period()), rows = rows_of(period());
  const int column_first = columns.index(window.origin_x + window.x_min - reach);
  const int column_last = columns.index(window.origin_x + window.x_max + reach);
  const int row_first = rows.index(window.origin_y + window.y_min - reach);
  const int row_last = rows.index(window.origin_y + window.y_max + reach);
  const auto image_of = [](int cell, int num_cells) {
    return static_cast<int>(std::floor(static_cast<double>(cell) / num_cells));
  };

  for (int row = row_first; row <= row_last; ++row) {
    const int image_y = image_of(row, rows.number);
    for (int column = column_first; column <= column_last; ++column) {
      const int image_x = image_of(column, columns.number);
      const std::size_t cell = static_cast<std::size_t>(row - image_y * rows.number) * columns.number +
                               (column - image_x * columns.number);
      for (std::uint32_t k = binned_.cell_start[cell]; k < binned_.cell_start[cell + 1]; ++k) {
        // Subtracts the origin first. Within the period this subtraction is exact, so that forces are the
        // same in every period.
        const double x = (binned_.obstacles[k].x - window.origin_x) + image_x * period().along();
        const double y = (binned_.obstacles[k].y - window.origin_y) + image_y * period().across();
        const double margin = window.margin + binned_.obstacles[k].radius;
        if (x >= window.x_min - margin && x <= window.x_max + margin && y >= window.y_min - margin &&
            y <= window.y_max + margin)
          visit(k, x, y);
      }
    }
  }
}

void ObstacleArray::gather(const Window& window, std::vector<Obstacle>& out) const {
  visit_window(window, [&](std::uint32_t k, double x, double y) {
    out.push_back({x, y, binned_.obstacles[k].radius});
  });
}

std::vector<std::uint32_t> ObstacleArray::posts() const {
  // The posts form a forest: each circle points to another circle of its post, the root points to itself.
  std::vector<std::uint32_t> post(binned_.obstacles.size());
  std::iota(post.begin(), post.end(), 0u);
  const auto root_of = [&](std::uint32_t circle) {
    while (post[circle] != circle) circle = post[circle] = post[post[circle]];
    return circle;
  };
  for (std::uint32_t first = 0; first < post.size(); ++first) {
    const auto& [origin_x, origin_y, radius] = binned_.obstacles[first];
    visit_window({origin_x, origin_y, 0, 0, 0, 0, radius},
                 [&, r = radius](std::uint32_t second, double x, double y) {
                   if (share_a_post(std::hypot(x, y), r, binned_.obstacles[second].radius))
                     post[root_of(first)] = root_of(second);
                 });
  }
  for (std::uint32_t circle = 0; circle < post.size(); ++circle) post[circle] = root_of(circle);
  return post;
}

bool ObstacleArray::is_within_post(const Eigen::Array2d& place) const {
  // Follows each post from circle to circle, and from circles to walls. If two paths meet and together make a
  // turn about the place, the post surrounds the place.
  constexpr double same = 1e-6;  // sigma, between two places of one circle
  struct Reached {
    std::uint32_t circle;
    Eigen::Array2d centre;  // relative to `place`
    int turns;              // crossings_of_axis() along the path to this circle
  };
  std::vector<std::vector<Reached>> reached(binned_.obstacles.size());
  std::vector<Reached> open;
  std::vector<std::optional<Reached>> at_wall(wedges_.size());
  const auto known = [&](std::uint32_t circle, const Eigen::Array2d& centre) -> const Reached* {
    for (const Reached& one : reached[circle])
      if ((one.centre - centre).abs().maxCoeff() < same) return &one;
    return nullptr;
  };
  const auto reach = [&](const Reached& one) {
    reached[one.circle].push_back(one);
    open.push_back(one);
  };
  bool surrounds = false;
  const auto look_around = [&](const Reached& from) {
    const auto& [origin_x, origin_y, radius] = binned_.obstacles[from.circle];
    visit_window(
        {origin_x, origin_y, 0, 0, 0, 0, radius}, [&, r = radius](std::uint32_t k, double x, double y) {
          if (!share_a_post(std::hypot(x, y), r, binned_.obstacles[k].radius)) return;
          const Eigen::Array2d centre = from.centre + Eigen::Array2d(x, y);
          const int turns = from.turns + crossings_of_axis(from.centre, centre);
          if (const Reached* const before = known(k, centre))
            surrounds |= before->turns != turns;
          else if (std::abs(centre[0]) <= period().along() && std::abs(centre[1]) <= period().across())
            reach({k, centre, turns});
        });
    for (std::size_t w = 0; w < wedges_.size(); ++w) {
      const auto [distance, normal] = distance_to(wedges_[w], place + from.centre - wedges_[w].centre());
      if (distance > radius) continue;
      const Eigen::Array2d foot = from.centre - distance * normal;
      const int turns = from.turns + crossings_of_axis(from.centre, foot);
      if (!at_wall[w]) at_wall[w] = {from.circle, foot, turns};
      surrounds |= at_wall[w]->turns + crossings_of_axis(at_wall[w]->centre, foot) != turns;
    }
  };
  // A post that surrounds the place crosses the positive x axis.
  visit_window({place[0], place[1], 0, period().along(), 0, 0, 0},
               [&](std::uint32_t first, double x, double y) {
                 if (surrounds || known(first, {x, y}) != nullptr) return;
                 std::ranges::fill(at_wall, std::nullopt);
                 reach({first, {x, y}, 0});
                 while (!open.empty() && !surrounds) {
                   const Reached next = open.back();
                   open.pop_back();
                   look_around(next);
                 }
               });
  return surrounds;
}

std::vector<int> posts_among(std::span<const Obstacle> circles) {
  constexpr int unknown = -1;
  std::vector<int> post(circles.size(), unknown);
  std::vector<std::size_t> reached;
  int num_posts = 0;
  for (std::size_t first = 0; first < circles.size(); ++first) {
    if (post[first] != unknown) continue;
    post[first] = num_posts++;
    reached.assign(1, first);
    while (!reached.empty()) {
      const Obstacle from = circles[reached.back()];
      const int of_from = post[reached.back()];
      reached.pop_back();
      for (std::size_t k = 0; k < circles.size(); ++k) {
        const Obstacle& circle = circles[k];
        if (post[k] != unknown ||
            !share_a_post(std::hypot(circle.x - from.x, circle.y - from.y), from.radius, circle.radius))
          continue;
        post[k] = of_from;
        reached.push_back(k);
      }
    }
  }
  return post;
}

/// The place of each circle in its post, without jumps at the borders of the period. NaN in posts that are
/// connected to their own periodic image, because the place is then ambiguous.
std::vector<Eigen::Array2d> ObstacleArray::places_in_posts() const {
  constexpr double nowhere = std::numeric_limits<double>::quiet_NaN(), same = 1e-6;  // sigma
  std::vector<std::optional<Eigen::Array2d>> places(binned_.obstacles.size());
  std::vector<std::uint32_t> open;
  for (std::uint32_t first = 0; first < places.size(); ++first) {
    if (places[first]) continue;
    std::vector<std::uint32_t> members;
    bool repeats = false;
    const auto reach = [&](std::uint32_t circle, const Eigen::Array2d& place) {
      if (places[circle]) {
        repeats |= !((*places[circle] - place).abs().maxCoeff() < same);
        return;
      }
      places[circle] = place;
      members.push_back(circle);
      open.push_back(circle);
    };
    reach(first, {0, 0});
    while (!open.empty()) {
      const std::uint32_t from = open.back();
      open.pop_back();
      const auto& [origin_x, origin_y, radius] = binned_.obstacles[from];
      visit_window({origin_x, origin_y, 0, 0, 0, 0, radius},
                   [&, r = radius](std::uint32_t k, double x, double y) {
                     if (share_a_post(std::hypot(x, y), r, binned_.obstacles[k].radius))
                       reach(k, *places[from] + Eigen::Array2d(x, y));
                   });
    }
    if (repeats)
      for (const std::uint32_t circle : members) places[circle] = {nowhere, nowhere};
  }
  std::vector<Eigen::Array2d> known;
  known.reserve(places.size());
  for (const auto& place : places) known.push_back(*place);
  return known;
}

ObstacleArray::Pair ObstacleArray::closest_pair() const {
  Pair closest{{}, {}, std::numeric_limits<double>::infinity()};
  const std::vector<std::uint32_t> post = posts();
  const std::vector<Eigen::Array2d> places = places_in_posts();
  const bool repeats_across = period().beside == 0;
  const double nearest_image =
      repeats_across ? std::min(period().along(), period().across()) : period().along();
  // The search finds all pairs nearer than the margin. The margin grows until the smallest distance is
  // certain.
  double margin = 0.125 * units::droplet_diameter;
  do {
    margin *= 2;
    for (std::uint32_t first = 0; first < binned_.obstacles.size(); ++first) {
      const auto& [origin_x, origin_y, radius] = binned_.obstacles[first];
      visit_window({origin_x, origin_y, -radius, radius, -radius, radius, margin},
                   [&, r = radius, from = origin_y](std::uint32_t second, double x, double y) {
                     if (!repeats_across && (from + y < 0 || from + y >= period().across())) return;
                     const double apart = std::hypot(x, y);
                     const double gap = apart - r - binned_.obstacles[second].radius;
                     // Circles with the same centre are a mistake even within a post.
                     const double off =
                         (places[second] - places[first] - Eigen::Array2d(x, y)).abs().maxCoeff();
                     const bool is_same_image = std::isnan(off) ? apart < nearest_image / 2 : off < 1e-6;
                     const bool is_one_post =
                         post[second] == post[first] && is_same_image && (apart > 0 || second == first);
                     if (!is_one_post && gap < closest.gap)
                       closest = {binned_.obstacles[first], binned_.obstacles[second], gap};
                   });
    }
  } while (closest.gap > margin && margin < nearest_image);
  return closest;
}

}  // namespace clog

#include "clog/core/obstacle_array.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "clog/core/error.hpp"
#include "clog/core/units.hpp"

namespace clog {
namespace {

double wrapped(double value, double period) {
  if (value >= 0 && value < period) return value;
  const double inside = value - period * std::floor(value / period);
  return inside < period ? inside : 0.0;  // a tiny negative value rounds up to the period itself
}

}  // namespace

ObstacleArray::ObstacleArray(double box, std::vector<Obstacle> obstacles, std::vector<Wedge> wedges)
    : box_(box),
      cells_per_side_(std::max(1, static_cast<int>(box / units::droplet_diameter))),
      obstacles_(std::move(obstacles)),
      wedges_(std::move(wedges)) {
  for (Obstacle& obstacle : obstacles_) {
    if (!(obstacle.radius > 0) || !std::isfinite(obstacle.radius) || !std::isfinite(obstacle.x) ||
        !std::isfinite(obstacle.y)) {
      std::ostringstream message;
      message << "invalid obstacle at x=" << obstacle.x << ", y=" << obstacle.y << " with diameter "
              << 2 * obstacle.radius << " (must be finite, the diameter positive)";
      throw Error(message.str());
    }
    obstacle.x = wrapped(obstacle.x, box_);
    obstacle.y = wrapped(obstacle.y, box_);
    largest_radius_ = std::max(largest_radius_, obstacle.radius);
  }
  bin_obstacles();
}

std::uint32_t ObstacleArray::cell_of(double x, double y) const {
  const auto index = [this](double value) {
    return std::min(static_cast<int>(value / box_ * cells_per_side_), cells_per_side_ - 1);
  };
  return static_cast<std::uint32_t>(index(y)) * cells_per_side_ + index(x);
}

void ObstacleArray::bin_obstacles() {
  const std::size_t num_cells = static_cast<std::size_t>(cells_per_side_) * cells_per_side_;
  cell_start_.assign(num_cells + 1, 0);
  std::vector<std::uint32_t> target(obstacles_.size());
  for (std::size_t i = 0; i < target.size(); ++i) {
    target[i] = cell_of(obstacles_[i].x, obstacles_[i].y);
    ++cell_start_[target[i] + 1];
  }
  for (std::size_t cell = 0; cell < num_cells; ++cell) cell_start_[cell + 1] += cell_start_[cell];
  std::vector<std::uint32_t> next(cell_start_.begin(), cell_start_.end() - 1);
  for (std::uint32_t& place : target) place = next[place]++;
  // In place: a second copy would be most of the memory that it takes to build an array.
  for (std::size_t i = 0; i < target.size(); ++i)
    while (target[i] != i) {
      const std::uint32_t place = target[i];
      std::swap(obstacles_[i], obstacles_[place]);
      std::swap(target[i], target[place]);
    }
}

template <class Visit>
void ObstacleArray::visit_window(const Window& window, Visit visit) const {
  const double reach = window.margin + largest_radius_;
  const double cells_per_length = cells_per_side_ / box_;
  const auto cell_index = [=](double position) {
    return static_cast<int>(std::floor(position * cells_per_length));
  };
  const int column_first = cell_index(window.origin_x + window.x_min - reach);
  const int column_last = cell_index(window.origin_x + window.x_max + reach);
  const int row_first = cell_index(window.origin_y + window.y_min - reach);
  const int row_last = cell_index(window.origin_y + window.y_max + reach);
  const auto image_of = [this](int cell) {
    return static_cast<int>(std::floor(static_cast<double>(cell) / cells_per_side_));
  };

  for (int row = row_first; row <= row_last; ++row) {
    const int image_y = image_of(row);
    for (int column = column_first; column <= column_last; ++column) {
      const int image_x = image_of(column);
      const std::size_t cell = static_cast<std::size_t>(row - image_y * cells_per_side_) * cells_per_side_ +
                               (column - image_x * cells_per_side_);
      for (std::uint32_t k = cell_start_[cell]; k < cell_start_[cell + 1]; ++k) {
        // Subtract the origin first: within the box this is exact, so forces do not depend on where the
        // droplet is.
        const double x = (obstacles_[k].x - window.origin_x) + image_x * box_;
        const double y = (obstacles_[k].y - window.origin_y) + image_y * box_;
        const double margin = window.margin + obstacles_[k].radius;
        if (x >= window.x_min - margin && x <= window.x_max + margin && y >= window.y_min - margin &&
            y <= window.y_max + margin)
          visit(k, x, y);
      }
    }
  }
}

void ObstacleArray::gather(const Window& window, std::vector<Obstacle>& out) const {
  visit_window(window, [&](std::uint32_t k, double x, double y) {
    out.push_back({x, y, obstacles_[k].radius});
  });
}

ObstacleArray::Pair ObstacleArray::closest_pair() const {
  Pair closest{{}, {}, std::numeric_limits<double>::infinity()};
  // Pairs nearer than the margin are all seen; widen it until the smallest one found is certain.
  double margin = 0.125 * units::droplet_diameter;
  do {
    margin *= 2;
    for (std::uint32_t first = 0; first < obstacles_.size(); ++first) {
      const auto& [origin_x, origin_y, radius] = obstacles_[first];
      visit_window({origin_x, origin_y, -radius, radius, -radius, radius, margin},
                   [&, r = radius](std::uint32_t second, double x, double y) {
                     const double gap = std::hypot(x, y) - r - obstacles_[second].radius;
                     const bool is_itself = second == first && std::hypot(x, y) < box_ / 2;
                     if (!is_itself && gap < closest.gap)
                       closest = {obstacles_[first], obstacles_[second], gap};
                   });
    }
  } while (closest.gap > margin && margin < box_);
  return closest;
}

}  // namespace clog

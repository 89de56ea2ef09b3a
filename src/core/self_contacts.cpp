#include "clog/core/self_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "clog/core/polygon.hpp"

namespace clog {
namespace {

/// Vertices closer than this many diameters along the contour do not repel each other.
constexpr double contour_exclusion = 3;

}  // namespace

EdgeContact nearest_point(const SelfContacts::Pair& pair, const double* x, const double* y,
                          int num_vertices) {
  const int begin = pair.edge;
  const int end = begin + 1 < num_vertices ? begin + 1 : 0;
  const double ex = x[end] - x[begin];
  const double ey = y[end] - y[begin];
  const double rx = x[pair.vertex] - x[begin];
  const double ry = y[pair.vertex] - y[begin];
  const double fraction = std::clamp((rx * ex + ry * ey) / (ex * ex + ey * ey), 0.0, 1.0);
  const double dx = rx - fraction * ex;
  const double dy = ry - fraction * ey;
  return {std::sqrt(dx * dx + dy * dy), fraction, dx, dy};
}

void SelfContacts::update(const DropletState& state, const Travel& travel) {
  const Eigen::Index n = state.size();
  if (reference_.size() == 2 * n) {
    const Eigen::Array2d centre = state.centre();
    const double farthest2 = ((state.x() - centre[0] - reference_.head(n)).square() +
                              (state.y() - centre[1] - reference_.tail(n)).square())
                                 .maxCoeff();
    if (std::sqrt(farthest2) + travel.relative < skin_) return;
  }
  // Thin enough that neighbours along a straight contour stay out of reach, unless the droplet moves very
  // fast.
  rebuild(state, std::clamp(2 * travel.relative, 0.5 * diameter_, widest_skin));
}

void SelfContacts::rebuild(const DropletState& state, double skin) {
  skin_ = skin;
  const int n = static_cast<int>(state.size());
  const double* x = state.position.data();
  const double* y = x + n;
  const Eigen::Array2d centre = state.centre();
  reference_ = state.position;
  reference_.head(n) -= centre[0];
  reference_.tail(n) -= centre[1];
  pairs_.clear();
  items_.clear();
  if (!reference_.allFinite()) return;  // a droplet that has diverged; the run will see it at its next check

  // The nearest point of an edge within reach lies within half an edge of one of its ends.
  double longest2 = 0;
  for (int i = 0, j = n - 1; i < n; j = i++)
    longest2 = std::max(longest2, (x[i] - x[j]) * (x[i] - x[j]) + (y[i] - y[j]) * (y[i] - y[j]));
  const double mean_edge = polygon_shape(state.position).perimeter / n;
  const double reach = diameter_ + 2 * skin_;
  const double end_reach = reach + 0.5 * std::sqrt(longest2);
  const int exclusion = std::max(1, static_cast<int>(std::ceil(contour_exclusion * diameter_ / mean_edge)));

  const double left = state.x().minCoeff();
  const double bottom = state.y().minCoeff();
  // One empty cell all around spares the border checks.
  const int columns = static_cast<int>((state.x().maxCoeff() - left) / end_reach) + 3;
  const int rows = static_cast<int>((state.y().maxCoeff() - bottom) / end_reach) + 3;
  const auto cell_of = [&](int vertex) {
    return (static_cast<int>((y[vertex] - bottom) / end_reach) + 1) * columns +
           static_cast<int>((x[vertex] - left) / end_reach) + 1;
  };
  head_.assign(static_cast<std::size_t>(rows) * columns, -1);
  next_.resize(n);
  for (int i = 0; i < n; ++i) {
    int& head = head_[cell_of(i)];
    next_[i] = head;
    head = i;
  }

  const auto contour_steps = [n](int a, int b) {
    const int steps = std::abs(a - b);
    return std::min(steps, n - steps);
  };
  for (int vertex = 0; vertex < n; ++vertex) {
    const std::size_t first = pairs_.size();
    const int cell = cell_of(vertex);
    for (int row = -1; row <= 1; ++row)
      for (int column = -1; column <= 1; ++column)
        for (int other = head_[cell + row * columns + column]; other >= 0; other = next_[other]) {
          if (contour_steps(vertex, other) < exclusion) continue;
          for (const int edge : {other, other > 0 ? other - 1 : n - 1}) {
            const int end = edge + 1 < n ? edge + 1 : 0;
            if (contour_steps(vertex, edge) < exclusion || contour_steps(vertex, end) < exclusion) continue;
            if (nearest_point({vertex, edge}, x, y, n).distance <= reach) pairs_.push_back({vertex, edge});
          }
        }
    // An edge is found from either end.
    const auto begin = pairs_.begin() + static_cast<std::ptrdiff_t>(first);
    std::sort(begin, pairs_.end(), [](const Pair& a, const Pair& b) { return a.edge < b.edge; });
    pairs_.erase(
        std::unique(begin, pairs_.end(), [](const Pair& a, const Pair& b) { return a.edge == b.edge; }),
        pairs_.end());
  }
  fill_items();
}

void SelfContacts::fill_items() {
  items_.clear();
  for (const Pair& pair : pairs_) {
    const int group = pair.edge / WallContacts::edges_per_group;
    if (items_.empty() || items_.back().vertex != pair.vertex || items_.back().group != group)
      items_.push_back({pair.vertex, group, 0});
    items_.back().edges |= static_cast<std::uint8_t>(1u << (pair.edge % WallContacts::edges_per_group));
  }
}

}  // namespace clog

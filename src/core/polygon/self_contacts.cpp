#include "clog/core/polygon/self_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace clog {
namespace {

/// Vertices closer than this many ranges along the contour do not repel each other.
constexpr double contour_exclusion = 3;

}  // namespace

void SelfContacts::set_rest_edge(double length) {
  rest_edge_ = length;
  exclusion_ = std::max(1, static_cast<int>(std::ceil(contour_exclusion * range_ / rest_edge_)));
  invalidate();
}

bool SelfContacts::are_neighbours(int a, int b) const {
  const int n = static_cast<int>(along_.size()) - 1;
  const int steps = std::abs(a - b);
  if (std::min(steps, n - steps) >= exclusion_) return false;
  const double way = std::abs(along_[a] - along_[b]);
  return std::min(way, along_.back() - way) < contour_exclusion * range_;
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
  // Thin enough that neighbours along a straight contour at rest stay out of reach, unless the droplet moves
  // very fast.
  const double usual_skin = (exclusion_ * rest_edge_ - range_) / 4;
  rebuild(state, std::clamp(2 * travel.relative, usual_skin, widest_skin));
}

double SelfContacts::measure_edges(const double* x, const double* y, int n) {
  double longest = 0;
  along_.assign(1, 0);
  for (int i = 0; i < n; ++i) {
    const int end = i + 1 < n ? i + 1 : 0;
    const double length = std::sqrt((x[end] - x[i]) * (x[end] - x[i]) + (y[end] - y[i]) * (y[end] - y[i]));
    longest = std::max(longest, length);
    along_.push_back(along_.back() + length);
  }
  return longest;
}

SelfContacts::Cells SelfContacts::sort_into_cells(const DropletState& state, double size) {
  const double left = state.x().minCoeff();
  const double bottom = state.y().minCoeff();
  // One empty cell all around spares the border checks.
  const int columns = static_cast<int>((state.x().maxCoeff() - left) / size) + 3;
  const int rows = static_cast<int>((state.y().maxCoeff() - bottom) / size) + 3;
  const Cells cells{left, bottom, size, columns};
  const int n = static_cast<int>(state.size());
  head_.assign(static_cast<std::size_t>(rows) * columns, -1);
  next_.resize(n);
  for (int i = 0; i < n; ++i) {
    int& head = head_[cells.cell_of(state.x()[i], state.y()[i])];
    next_[i] = head;
    head = i;
  }
  return cells;
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
  const double reach = range_ + 2 * skin_;
  const double end_reach = reach + 0.5 * measure_edges(x, y, n);
  const Cells cells = sort_into_cells(state, end_reach);
  const auto is_near = [&](int a, int b) {
    return (x[a] - x[b]) * (x[a] - x[b]) + (y[a] - y[b]) * (y[a] - y[b]) <= end_reach * end_reach;
  };
  const auto add_if_near = [&](const Pair& pair) {
    const int end = pair.edge + 1 < n ? pair.edge + 1 : 0;
    if (!are_neighbours(pair.vertex, pair.edge) && !are_neighbours(pair.vertex, end) &&
        nearest_point(pair, x, y, n).distance <= reach)
      pairs_.push_back(pair);
  };
  for (int vertex = 0; vertex < n; ++vertex) {
    const int cell = cells.cell_of(x[vertex], y[vertex]);
    for (int row = -1; row <= 1; ++row)
      for (int column = -1; column <= 1; ++column)
        for (int other = head_[cell + row * cells.columns + column]; other >= 0; other = next_[other]) {
          if (are_neighbours(vertex, other) || !is_near(vertex, other)) continue;
          add_if_near({vertex, other});
          // The edge that ends here is found from its beginning, if that is near.
          const int before = other > 0 ? other - 1 : n - 1;
          if (!is_near(vertex, before)) add_if_near({vertex, before});
        }
  }
  fill_items(state);
}

void SelfContacts::fill_items(const DropletState& state) {
  constexpr int group_size = WallContacts::edges_per_group;
  const int n = static_cast<int>(state.size());
  const double* x = state.position.data();
  const double* y = x + n;
  items_.clear();
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    return std::pair(a.edge / group_size, a.vertex) < std::pair(b.edge / group_size, b.vertex);
  });
  item_of_.assign(2 * static_cast<std::size_t>(n), -1);  // the latest
  for (const Pair& pair : pairs_) {
    const int before = pair.vertex > 0 ? pair.vertex - 1 : n - 1, after = (pair.vertex + 1) % n;
    const int end = (pair.edge + 1) % n;
    const bool backwards =
        (x[after] - x[before]) * (x[end] - x[pair.edge]) + (y[after] - y[before]) * (y[end] - y[pair.edge]) <
        0;
    const int edges = pair.edge / group_size * group_size;
    const int bit = pair.edge - edges;
    const int vertices = (pair.vertex - (backwards ? group_size - 1 - bit : bit) + n) % n;
    int& item = item_of_[vertices + (backwards ? n : 0)];
    if (item < 0 || items_[item].edges != edges) {
      item = static_cast<int>(items_.size());
      items_.push_back({edges, vertices, 0, backwards});
    }
    items_[item].pairs |= static_cast<std::uint8_t>(1u << bit);
  }
}

}  // namespace clog

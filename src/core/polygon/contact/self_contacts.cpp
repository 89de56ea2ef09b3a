#include "clog/core/polygon/contact/self_contacts.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "close_vertices.hpp"

namespace clog {
namespace {

/// Vertices that are closer than this many ranges along the contour do not repel each other.
constexpr double contour_exclusion = 3;

}  // namespace

void SelfContacts::set_rest_edge(double length) {
  assert(length > 0);
  rest_edge_ = length;
  exclusion_ = std::max(1, static_cast<int>(std::ceil(contour_exclusion * range_ / rest_edge_)));
  invalidate();
}

bool SelfContacts::are_neighbours(int a, int b) const {
  const int n = static_cast<int>(along_.size()) - 1;
  assert(std::min(a, b) >= 0 && std::max(a, b) < n);
  const int steps = std::abs(a - b);
  if (std::min(steps, n - steps) >= exclusion_) return false;
  const double way = std::abs(along_[a] - along_[b]);
  return std::min(way, along_.back() - way) < contour_exclusion * range_;
}

void SelfContacts::update(const DropletState& state, const Travel& travel) {
  const Eigen::Index n = state.size();
  if (reference_.size() == 2 * n + WallContacts::edges_per_group) {
    const Eigen::Array2d centre = state.centre();
    const double farthest2 = ((state.x() - centre[0] - reference_.head(n)).square() +
                              (state.y() - centre[1] - reference_.segment(n, n)).square())
                                 .maxCoeff();
    if (hold(std::sqrt(farthest2), travel)) return;
  }
  rebuild(state, travel);
}

bool SelfContacts::hold(double moved, const Travel& travel) const {
  return reference_.size() > 0 && moved + travel.relative < skin_;
}

void SelfContacts::rebuild(const DropletState& state, const Travel& travel) {
  // The usual skin is so thin that the list contains no neighbours along a straight contour at rest. A very
  // fast droplet needs a thicker skin.
  const double usual_skin = (exclusion_ * rest_edge_ - range_) / 4;
  rebuild_with_skin(state, std::clamp(2 * travel.relative, usual_skin, widest_skin));
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

/// Fills close_ with pairs of vertices.
void SelfContacts::find_close(const double* x, const double* y, double longest_edge, double reach) {
  constexpr double rounding = 1e-12;
  const int n = static_cast<int>(along_.size()) - 1;
  const int stride = n + kernel::close_vertices_beyond;
  contour_.resize(std::size_t{3} * stride);
  double *to_x = contour_.data(), *to_y = to_x + stride, *to_along = to_y + stride;
  std::copy_n(x, n, to_x);
  std::copy_n(y, n, to_y);
  std::copy_n(along_.data(), n, to_along);
  for (int i = n; i < stride; ++i) {
    to_x[i] = to_x[i - n];
    to_y[i] = to_y[i - n];
    to_along[i] = to_along[i - n] + along_[n];
  }
  kernel::find_close_vertices({.n = n,
                               .x = to_x,
                               .y = to_y,
                               .along = to_along,
                               .longest_edge = longest_edge,
                               .reach = reach * (1 + rounding),
                               .exclusion = exclusion_,
                               .arc = contour_exclusion * range_ * (1 - rounding)},
                              groups_, close_);
}

void SelfContacts::rebuild_with_skin(const DropletState& state, double skin) {
  skin_ = skin;
  const int n = static_cast<int>(state.size());
  const double* x = state.position.data();
  const double* y = x + n;
  const Eigen::Array2d centre = state.centre();
  reference_.resize(2 * n + WallContacts::edges_per_group);
  reference_.head(n) = state.x() - centre[0];
  reference_.segment(n, n) = state.y() - centre[1];
  reference_.tail(WallContacts::edges_per_group).setZero();
  pairs_.clear();
  items_.clear();
  if (!reference_.allFinite()) return;  // the droplet has diverged; the run detects this at its next check

  // The point of an edge that is closest to a vertex is at most half an edge from one of the edge's ends.
  const double reach = range_ + 2 * skin_;
  const double longest_edge = measure_edges(x, y, n);
  const double end_reach = reach + 0.5 * longest_edge;
  find_close(x, y, longest_edge, end_reach);
  const auto is_near = [&](int a, int b) {
    return (x[a] - x[b]) * (x[a] - x[b]) + (y[a] - y[b]) * (y[a] - y[b]) <= end_reach * end_reach;
  };
  const auto add_if_near = [&](const Pair& pair) {
    const int end = pair.edge + 1 < n ? pair.edge + 1 : 0;
    if (!are_neighbours(pair.vertex, pair.edge) && !are_neighbours(pair.vertex, end) &&
        nearest_point(pair, x, y, n).distance <= reach)
      pairs_.push_back(pair);
  };
  const auto add_edges_of = [&](int vertex, int other) {
    add_if_near({vertex, other});
    // If the first vertex of the edge that ends at `other` is also near, this edge is listed for that vertex.
    const int before = other > 0 ? other - 1 : n - 1;
    if (!is_near(vertex, before)) add_if_near({vertex, before});
  };
  for (const auto& [one, other] : close_) {
    if (are_neighbours(one, other) || !is_near(one, other)) continue;
    add_edges_of(one, other);
    add_edges_of(other, one);
  }
  if (!pairs_.empty()) fill_items(state);
}

/// Sorts the pairs by the groups of their edges, in the order of the contour. Pairs of the same group keep
/// their order.
void SelfContacts::sort_pairs_by_groups(int n) {
  constexpr int group_size = WallContacts::edges_per_group;
  end_of_group_.assign(static_cast<std::size_t>(n / group_size) + 2, 0);
  for (const Pair& pair : pairs_) ++end_of_group_[pair.edge / group_size + 1];
  std::partial_sum(end_of_group_.begin(), end_of_group_.end(), end_of_group_.begin());
  sorted_.resize(pairs_.size());
  for (const Pair& pair : pairs_) sorted_[end_of_group_[pair.edge / group_size]++] = pair;
  std::swap(pairs_, sorted_);
}

void SelfContacts::fill_items(const DropletState& state) {
  constexpr int group_size = WallContacts::edges_per_group;
  const int n = static_cast<int>(state.size());
  const double* x = state.position.data();
  const double* y = x + n;
  items_.clear();
  sort_pairs_by_groups(n);
  item_of_.assign(2 * static_cast<std::size_t>(n), -1);  // the latest item
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

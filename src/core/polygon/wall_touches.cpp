#include "clog/core/polygon/wall_touches.hpp"

#include <algorithm>
#include <cmath>

#include "clog/core/droplet/shape.hpp"
#include "clog/core/tools/units.hpp"
#include "dp_kernel.hpp"

namespace clog {

WallTouches::WallTouches(const RunParameters& run, const ObstacleArray& obstacles)
    : obstacles_(&obstacles),
      range_(run.dp.contact_range.value()),
      stiffness_(contact_stiffness(run.wall_stiffness.value(), units::regular_edge_length(*run.dp.vertices))),
      meets_edges_(run.dp.wall_contact == WallContact::edge) {}

WallTouches::Part& WallTouches::part(int vertex, const WallPlace& wall) {
  for (int i = first_part_[vertex]; i >= 0; i = parts_[i].next)
    if (parts_[i].wall.is(wall)) return parts_[i];
  parts_.push_back({.vertex = vertex, .wall = wall, .next = first_part_[vertex]});
  first_part_[vertex] = static_cast<int>(parts_.size()) - 1;
  return parts_.back();
}

void WallTouches::add_edge(const Eigen::ArrayXd& position, int edge, const WallPlace& circle) {
  const auto n = static_cast<int>(position.size() / 2);
  const int vertices[4] = {(edge + n - 1) % n, edge, (edge + 1) % n, (edge + 2) % n};
  constexpr double shares[4] = {refined_far, refined_near, refined_near, refined_far};
  const auto vertex = [&](int k) { return Eigen::Array2d(position[vertices[k]], position[n + vertices[k]]); };
  Eigen::Array2d middle{0, 0};
  for (int k = 0; k < 4; ++k) middle += shares[k] * vertex(k);
  const Eigen::Array2d centre{circle.x, circle.y};
  const double reach = circle.radius + range_;
  // Most edges of the list touch nothing. No half is longer than the sum of its two components, which takes
  // no root.
  const auto is_far = [&](int end) {
    const double farthest = reach + (middle - vertex(end)).abs().sum();
    return (vertex(end) - centre).square().sum() > (1 + 1e-12) * farthest * farthest;
  };
  if (is_far(1) && is_far(2)) return;
  Eigen::Array2d pushes[4] = {{0, 0}, {0, 0}, {0, 0}, {0, 0}};
  double wetted[4] = {0, 0, 0, 0};
  bool touches = false;
  for (const int end : {1, 2}) {
    const double length = (middle - vertex(end)).matrix().norm();
    // No point of the half is farther from its end than it is long.
    if ((vertex(end) - centre).matrix().squaredNorm() > (reach + length) * (reach + length)) continue;
    const Eigen::Array2d nearest = nearest_on_segment(centre, vertex(end), middle);
    const double distance = (nearest - centre).matrix().norm();
    const double overlap = reach - distance;
    if (!(overlap > 0 && distance > 0)) continue;
    touches = true;
    const double to_middle = length > 0 ? (nearest - vertex(end)).matrix().norm() / length : 0;
    const Eigen::Array2d push = stiffness_ * overlap / distance * (nearest - centre);
    pushes[end] += (1 - to_middle) * push;
    for (int k = 0; k < 4; ++k) pushes[k] += to_middle * shares[k] * push;
    // A half is as long on the wall as it is; the middle belongs to both vertices.
    wetted[end] += 0.75 * length;
    wetted[3 - end] += 0.25 * length;
  }
  if (!touches) return;
  for (int k = 0; k < 4; ++k) {
    Part& touched = part(vertices[k], circle);
    touched.push += pushes[k];
    touched.wetted += wetted[k];
  }
}

void WallTouches::add_vertex(const Eigen::ArrayXd& position, int vertex, const WallPlace& wall,
                             double distance, const Eigen::Array2d& normal) {
  if (!(distance < range_)) return;
  const auto n = static_cast<int>(position.size() / 2);
  const auto length = [&](int i, int j) {
    return std::hypot(position[i] - position[j], position[n + i] - position[n + j]);
  };
  Part& touched = part(vertex, wall);
  touched.push += stiffness_ * (range_ - distance) * normal;
  // Where a wedge's tip touches the edges as well, this counts the same length again.
  const double own = (length(vertex, (vertex + 1) % n) + length(vertex, (vertex + n - 1) % n)) / 2;
  touched.wetted = std::max(touched.wetted, own);
}

const std::vector<WallTouch>& WallTouches::find(const DropletState& state,
                                                std::span<const WallContacts::Item> circles) {
  const auto n = static_cast<int>(state.size());
  first_part_.assign(static_cast<std::size_t>(n), -1);
  parts_.clear();
  const std::vector<Wedge>& wedges = obstacles_->wedges();
  std::vector<WallPlace> wedge_places;
  for (const Wedge& wedge : wedges) {
    const kernel::WedgePlace place = kernel::place_in(state.frame, wedge);
    wedge_places.push_back({place.x, place.y, place.radius, static_cast<Eigen::Index>(wedge_places.size())});
  }
  for (const WallContacts::Item& item : circles) {
    WallPlace circle{.x = item.x, .y = item.y, .radius = item.reach - range_};
    // The rounded tip of a wedge is in the list as a circle.
    for (const WallPlace& wedge : wedge_places)
      if (wedge.x == circle.x && wedge.y == circle.y) circle.wedge = wedge.wedge;
    for (int bit = 0; bit < WallContacts::edges_per_group; ++bit) {
      if ((item.edges >> bit & 1) == 0) continue;
      const int i = item.group * WallContacts::edges_per_group + bit;
      if (meets_edges_) {
        add_edge(state.position, i, circle);
        continue;
      }
      const Eigen::Array2d away = Eigen::Array2d(state.x()[i], state.y()[i]) - Eigen::Array2d(item.x, item.y);
      const double r = away.matrix().norm();
      if (r > 0) add_vertex(state.position, i, circle, r - circle.radius, away / r);
    }
  }
  for (std::size_t k = 0; k < wedges.size(); ++k)
    for (int i = 0; i < n; ++i) {
      const Eigen::Array2d from_centre{state.x()[i] - wedge_places[k].x, state.y()[i] - wedge_places[k].y};
      const auto [distance, normal] = distance_to(wedges[k], from_centre);
      add_vertex(state.position, i, wedge_places[k], distance, normal);
    }

  touches_.clear();
  for (const Part& one : parts_) {
    const Eigen::Array2d from_centre{state.x()[one.vertex] - one.wall.x, state.y()[one.vertex] - one.wall.y};
    const Eigen::Array2d normal = distance_to(one.wall, wedges, from_centre).normal;
    // The middle next to the end of a contact pulls the vertex behind it a little towards the wall.
    const double push = std::max(0.0, (one.push * normal).sum());
    if (push > 0 || one.wetted > 0) touches_.push_back({one.vertex, one.wall, push, one.wetted});
  }
  return touches_;
}

}  // namespace clog

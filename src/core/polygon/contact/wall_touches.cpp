#include "clog/core/polygon/contact/wall_touches.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "clog/core/droplet/shape.hpp"
#include "clog/core/tools/units.hpp"
#include "touch_kernel.hpp"
#include "wedge_place.hpp"

namespace clog {

namespace {

WallFoot foot_on_circle(double radius, const Eigen::Array2d& normal, double gradient) {
  return {radius * normal, {-normal[1], normal[0]}, gradient};
}

std::size_t whole_groups(std::size_t number) {
  constexpr std::size_t group = kernel::GroupTouches::edges;
  return (number + group - 1) / group * group;
}

}  // namespace

WallFoot foot_on(const WallPlace& wall, std::span<const Wedge> wedges, const Eigen::Array2d& from_centre) {
  const double r = from_centre.matrix().norm();
  WallFoot on_circle = foot_on_circle(wall.radius, from_centre / r, wall.radius / r);
  if (wall.wedge < 0) return on_circle;
  const Wedge& wedge = wedges[static_cast<std::size_t>(wall.wedge)];
  const auto [distance, normal] = distance_to(wedge, from_centre);
  const bool is_on_flank = (normal * wedge.axis).sum() > -wedge.half_angle.sin - 1e-12;
  if (!is_on_flank) return on_circle;
  return {from_centre - distance * normal, {-normal[1], normal[0]}, 1};
}

WallTouches::WallTouches(const RunParameters& run, const ObstacleArray& obstacles)
    : obstacles_(&obstacles),
      range_(run.dp.contact_range.value()),
      stiffness_(contact_stiffness(run.wall_stiffness.value(), units::regular_edge_length(*run.dp.vertices))),
      meets_edges_(run.dp.wall_contact == WallContact::edge),
      acts_through_films_(run.dp.film_friction == FilmFriction::on) {}

int WallTouches::part(int vertex, const WallPlace& wall) {
  for (int i = first_part_[vertex]; i >= 0; i = parts_[i].next)
    if (parts_[i].wall.is(wall)) return i;
  parts_.push_back({.vertex = vertex, .wall = wall, .next = first_part_[vertex]});
  return first_part_[vertex] = static_cast<int>(parts_.size()) - 1;
}

void WallTouches::add_edges(const Contour& contour, const WallContacts::Item& item, const WallPlace& circle) {
  static const kernel::TouchKernel touch_kernel = kernel::touch_kernel();
  const int first = item.group * WallContacts::edges_per_group;
  kernel::GroupTouches found{};
  touch_kernel.touch(contour.x + first, contour.y + first, {circle.x, circle.y, circle.radius + range_},
                     stiffness_, found);
  int parts[WallContacts::edges_per_group + 3];
  std::ranges::fill(parts, -1);
  for (unsigned edges = found.touching & item.edges; edges != 0; edges &= edges - 1) {
    const int edge = std::countr_zero(edges);
    for (int k = 0; k < 4; ++k) {
      int& known = parts[edge + k];
      if (known < 0) known = part((first + edge + k - 1 + contour.size) % contour.size, circle);
      Part& touched = parts_[known];
      touched.push += Eigen::Array2d(found.push_x[k][edge], found.push_y[k][edge]);
      if ((k == 1 || k == 2) && item.layer == 0) touched.wetted += found.wetted[k - 1][edge];
    }
  }
}

void WallTouches::add_vertex(const Contour& contour, int vertex, const WallPlace& wall, double distance,
                             const Eigen::Array2d& normal) {
  if (!(distance < range_)) return;
  const auto length = [&](int i, int j) {
    return std::hypot(contour.x[i] - contour.x[j], contour.y[i] - contour.y[j]);
  };
  Part& touched = parts_[part(vertex, wall)];
  touched.push += stiffness_ * (range_ - distance) * normal;
  // If the tip of the wedge touches the vertex's edges, this length has already been counted for these edges.
  const double own = (length(vertex, vertex + 1) + length(vertex, vertex - 1)) / 2;
  touched.wetted = std::max(touched.wetted, own);
}

const std::vector<WallTouch>& WallTouches::find(const DropletState& state,
                                                std::span<const WallContacts::Item> circles) {
  const auto n = static_cast<std::size_t>(state.size());
  constexpr std::size_t before = 1, behind = WallContacts::edges_per_group + 2;
  closed_contour_.resize(2 * (before + n + behind));
  const auto close = [n](const double* from, double* to) {
    to[0] = from[n - 1];
    std::copy_n(from, n, to + before);
    std::copy_n(from, behind, to + before + n);
  };
  double *const x = closed_contour_.data(), *const y = x + before + n + behind;
  close(state.position.data(), x);
  close(state.position.data() + n, y);
  return find({static_cast<int>(n), x + before, y + before}, state.frame, circles);
}

const std::vector<WallTouch>& WallTouches::find(const Contour& contour, const LocalFrame& frame,
                                                std::span<const WallContacts::Item> circles) {
  first_part_.assign(static_cast<std::size_t>(contour.size), -1);
  parts_.clear();
  wedges_.clear();
  for (const Wedge& wedge : obstacles_->wedges()) {
    const kernel::WedgePlace place = kernel::place_in(frame, wedge);
    wedges_.push_back({place.x, place.y, place.radius, static_cast<Eigen::Index>(wedges_.size())});
  }
  for (const WallContacts::Item& item : circles) {
    if (item.layer > 0 && !acts_through_films_) continue;
    WallPlace circle{.x = item.x, .y = item.y, .radius = item.reach - range_};
    // The rounded tip of a wedge is in the list as a circle.
    for (const WallPlace& wedge : wedges_)
      if (item.layer == 0 && wedge.x == circle.x && wedge.y == circle.y) circle.wedge = wedge.wedge;
    if (meets_edges_) {
      add_edges(contour, item, circle);
      continue;
    }
    for (unsigned vertices = item.edges; vertices != 0; vertices &= vertices - 1) {
      const int i = item.group * WallContacts::edges_per_group + std::countr_zero(vertices);
      const Eigen::Array2d away{contour.x[i] - item.x, contour.y[i] - item.y};
      const double r = away.matrix().norm();
      if (r > 0) add_vertex(contour, i, circle, r - circle.radius, away / r);
    }
  }
  for (std::size_t k = 0; k < wedges_.size(); ++k)
    for (int i = 0; i < contour.size; ++i) {
      const Eigen::Array2d from_centre{contour.x[i] - wedges_[k].x, contour.y[i] - wedges_[k].y};
      const auto [distance, normal] = distance_to(obstacles_->wedges()[k], from_centre);
      add_vertex(contour, i, wedges_[k], distance, normal);
    }
  keep_pushed(contour);
  return touches_;
}

/// Keeps the parts that the wall pushes, or that wet it.
void WallTouches::keep_pushed(const Contour& contour) {
  static const kernel::TouchKernel touch_kernel = kernel::touch_kernel();
  auto& [dx, dy, radius, normal_x, normal_y, gradient] = directions_;
  for (std::vector<double>* values : {&dx, &dy, &radius, &normal_x, &normal_y, &gradient})
    values->resize(whole_groups(parts_.size()));
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Part& one = parts_[k];
    dx[k] = contour.x[one.vertex] - one.wall.x;
    dy[k] = contour.y[one.vertex] - one.wall.y;
    radius[k] = one.wall.radius;
  }
  touch_kernel.directions(parts_.size(), dx.data(), dy.data(), radius.data(), normal_x.data(),
                          normal_y.data(), gradient.data());
  touches_.clear();
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Part& one = parts_[k];
    const bool is_circle = one.wall.wedge < 0;
    const Eigen::Array2d from_centre{dx[k], dy[k]};
    const Eigen::Array2d normal = is_circle ? Eigen::Array2d(normal_x[k], normal_y[k])
                                            : distance_to(one.wall, obstacles_->wedges(), from_centre).normal;
    // At the end of a contact, the middle of the last edge pulls the next vertex a little towards the wall.
    // This pull does not count as a push.
    const double push = std::max(0.0, (one.push * normal).sum());
    if (!(push > 0) && !(one.wetted > 0)) continue;
    const WallFoot foot = is_circle ? foot_on_circle(one.wall.radius, normal, gradient[k])
                                    : foot_on(one.wall, obstacles_->wedges(), from_centre);
    touches_.push_back({one.vertex, one.wall, foot, push, one.wetted});
  }
}

}  // namespace clog

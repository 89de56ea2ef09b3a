#include "clog/core/polygon/contact/film_touches.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace clog {

void FilmTouches::add_to(std::vector<WallTouch>& touches, const Contour& contour, const SelfContacts& self) {
  find_walls(touches);
  if (walls_.empty()) return;
  find_pushes(contour, self);
  first_touch_.assign(static_cast<std::size_t>(contour.size), -1);
  next_touch_.assign(touches.size(), -1);
  for (std::size_t k = 0; k < touches.size(); ++k)
    next_touch_[k] = std::exchange(first_touch_[touches[k].vertex], static_cast<int>(k));
  const double reach = film_reach(wall_range_, self.range());
  const double least = least_film_push * stiffness_ * self.range();
  for (const int vertex : pushed_) {
    add_vertex(vertex, contour, reach, least, touches);
    pushes_[vertex] = {0, 0};
  }
  pushed_.clear();
}

void FilmTouches::find_walls(const std::vector<WallTouch>& touches) {
  walls_.clear();
  for (const WallTouch& touch : touches)
    if (touch.push > 0 &&
        std::ranges::none_of(walls_, [&](const WallPlace& wall) { return wall.is(touch.wall); }))
      walls_.push_back(touch.wall);
}

/// Computes the forces of self-contact as DpForces does.
void FilmTouches::find_pushes(const Contour& contour, const SelfContacts& self) {
  pushes_.resize(static_cast<std::size_t>(contour.size), {0, 0});
  for (const SelfContacts::Pair& pair : self.pairs()) {
    const EdgeContact contact = nearest_point(pair, contour.x, contour.y, contour.size);
    if (contact.distance >= self.range() || contact.distance == 0) continue;
    const double size = stiffness_ * (self.range() - contact.distance) / contact.distance;
    const Eigen::Array2d push{size * contact.dx, size * contact.dy};
    add_push(pair.vertex, push);
    add_push(pair.edge, -(1 - contact.fraction) * push);
    add_push(pair.edge + 1 < contour.size ? pair.edge + 1 : 0, -contact.fraction * push);
  }
}

void FilmTouches::add_push(int vertex, const Eigen::Array2d& push) {
  Eigen::Array2d& sum = pushes_[static_cast<std::size_t>(vertex)];
  if ((sum == 0).all()) pushed_.push_back(vertex);
  sum += push;
}

void FilmTouches::add_vertex(int vertex, const Contour& contour, double reach, double least,
                             std::vector<WallTouch>& touches) {
  const WallPlace* nearest = nullptr;
  WedgeDistance to_nearest{reach, {0, 0}};
  Eigen::Array2d from_nearest{0, 0};
  for (const WallPlace& wall : walls_) {
    const Eigen::Array2d from_centre{contour.x[vertex] - wall.x, contour.y[vertex] - wall.y};
    const WedgeDistance to_wall = distance_to(wall, wedges_, from_centre);
    if (!(to_wall.distance < to_nearest.distance)) continue;
    nearest = &wall;
    to_nearest = to_wall;
    from_nearest = from_centre;
  }
  if (nearest == nullptr) return;
  const double push = (pushes_[static_cast<std::size_t>(vertex)] * to_nearest.normal).sum();
  if (std::abs(push) < least) return;
  for (int k = first_touch_[vertex]; k >= 0; k = next_touch_[k])
    if (touches[k].wall.is(*nearest)) {
      touches[k].push = std::max(0.0, touches[k].push + push);
      return;
    }
  if (push > 0) touches.push_back({vertex, *nearest, foot_on(*nearest, wedges_, from_nearest), push, 0});
}

}  // namespace clog

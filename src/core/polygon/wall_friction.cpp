#include "clog/core/polygon/wall_friction.hpp"

#include <cmath>

namespace clog {

WallFriction::Foot WallFriction::foot(const WallPlace& wall, const DropletState& state,
                                      Eigen::Index vertex) const {
  const Eigen::Array2d from_centre{state.x()[vertex] - wall.x, state.y()[vertex] - wall.y};
  const auto on_circle = [&] {
    const double r = from_centre.matrix().norm();
    const Eigen::Array2d normal = from_centre / r;
    return Foot{wall.radius * normal, {-normal[1], normal[0]}, wall.radius / r};
  };
  if (wall.wedge < 0) return on_circle();
  const Wedge& wedge = wedges_[static_cast<std::size_t>(wall.wedge)];
  const auto [distance, normal] = distance_to(wedge, from_centre);
  const bool is_on_flank = (normal * wedge.axis).sum() > -wedge.half_angle.sin - 1e-12;
  if (!is_on_flank) return on_circle();
  return {from_centre - distance * normal, {-normal[1], normal[0]}, 1};
}

void WallFriction::add_forces(const DropletState& state, Eigen::Ref<Eigen::ArrayXd> force) const {
  const Eigen::Index n = state.size();
  for (const WallAnchor& anchor : state.anchors) {
    const Foot at = foot(anchor.wall, state, anchor.holder);
    const double slip = (at.along * (at.point - Eigen::Array2d(anchor.x, anchor.y))).sum();
    const double pull = -stiffness_ * anchor.slip_of_force(slip) * at.gradient;
    force[anchor.holder] += pull * at.along[0];
    force[n + anchor.holder] += pull * at.along[1];
  }
}

double WallFriction::energy(const DropletState& state) const {
  double energy = 0;
  for (const WallAnchor& anchor : state.anchors) {
    const Foot at = foot(anchor.wall, state, anchor.holder);
    energy += 0.5 * stiffness_ * (at.point - Eigen::Array2d(anchor.x, anchor.y)).square().sum();
  }
  return energy;
}

WallYield WallFriction::follow(DropletState& state, std::span<const WallTouch> touches, Purpose purpose,
                               KnownAnchors& known) const {
  WallYield yield;
  if (state.anchors.empty() && touches.empty()) return yield;
  known.take(state.anchors, state.size());
  for (const WallTouch& touch : touches) {
    const Foot at = foot(touch.wall, state, touch.vertex);
    if (!(at.gradient > 0)) continue;  // a sharp tip: there is nothing to slip along
    WallAnchor* const before = known.find(touch.vertex, touch.wall);
    if (before == nullptr) {
      state.anchors.push_back({touch.vertex, touch.wall, at.point[0], at.point[1]});
      continue;
    }
    WallAnchor anchor = *before;
    before->holder = -1;  // it is not lost
    const double slip = (at.along * (at.point - Eigen::Array2d(anchor.x, anchor.y))).sum();
    const double most = (coefficient_ * touch.push + traction_ * touch.wetted) / (stiffness_ * at.gradient);
    const double held = yield.hold(anchor, slip, -most, most, stiffness_, purpose);
    if (held != slip) {
      const Eigen::Array2d moved = at.point - held * at.along;
      anchor.x = moved[0];
      anchor.y = moved[1];
    }
    state.anchors.push_back(anchor);
  }
  for (const WallAnchor& anchor : known.all())
    if (anchor.holder >= 0) yield.forget(anchor, stiffness_);
  return yield;
}

}  // namespace clog

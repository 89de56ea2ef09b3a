#include "clog/core/polygon/contact/wall_friction.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace clog {

WallFoot WallFriction::foot(const DropletState& state, const WallAnchor& anchor) const {
  const WallPlace& wall = anchor.wall;
  return foot_on(wall, wedges_, {state.x()[anchor.holder] - wall.x, state.y()[anchor.holder] - wall.y});
}

void WallFriction::add_force(const WallAnchor& anchor, const WallFoot& at, Eigen::ArrayXd& force) const {
  const double slip = (at.along * (at.point - Eigen::Array2d(anchor.x, anchor.y))).sum();
  const double pull = -stiffness_ * anchor.slip_of_force(slip) * at.gradient;
  force[anchor.holder] += pull * at.along[0];
  force[force.size() / 2 + anchor.holder] += pull * at.along[1];
}

void WallFriction::add_forces(const DropletState& state, Eigen::ArrayXd& force) const {
  assert(force.size() == state.position.size());
  for (const WallAnchor& anchor : state.anchors) add_force(anchor, foot(state, anchor), force);
}

double WallFriction::energy(const DropletState& state) const {
  double energy = 0;
  for (const WallAnchor& anchor : state.anchors) {
    const WallFoot at = foot(state, anchor);
    energy += 0.5 * stiffness_ * (at.point - Eigen::Array2d(anchor.x, anchor.y)).square().sum();
  }
  return energy;
}

double WallFriction::use(const DropletState& state, std::span<const WallTouch> touches,
                         std::span<const Obstacle> circles) const {
  double most = std::numeric_limits<double>::quiet_NaN();
  for (const Obstacle& circle : circles) {
    const auto is_on = [&](const WallPlace& wall) {
      return wall.wedge < 0 && share_centre({wall.x, wall.y, wall.radius}, circle);
    };
    double carried = 0, bearable = 0;
    for (const WallTouch& touch : touches)
      if (is_on(touch.wall) && touch.foot.gradient > 0)
        bearable +=
            (coefficient_ * touch.push + traction_ * touch.wetted) * touch.wall.radius / touch.foot.gradient;
    for (const WallAnchor& anchor : state.anchors) {
      if (!is_on(anchor.wall)) continue;
      const WallFoot at = foot(state, anchor);
      const double slip = (at.along * (at.point - Eigen::Array2d(anchor.x, anchor.y))).sum();
      carried += stiffness_ * anchor.slip_of_force(slip) * anchor.wall.radius;
    }
    if (bearable > 0) most = std::fmax(most, std::min(1.0, std::abs(carried) / bearable));
  }
  return most;
}

/// hold_group() in dp_step_holds-inl.hpp is the version of this function for circles in contact with edges.
WallYield WallFriction::follow(DropletState& state, std::span<const WallTouch> touches, Purpose purpose,
                               KnownAnchors& known, Eigen::ArrayXd* force) const {
  assert(force == nullptr || force->size() == state.position.size());
  WallYield yield;
  if (state.anchors.empty() && touches.empty()) return yield;
  known.take(state.anchors, state.size());
  for (const WallTouch& touch : touches) {
    const WallFoot& at = touch.foot;
    if (!(at.gradient > 0)) continue;  // a sharp tip has no surface to slip along
    const double bears = coefficient_ * touch.push + traction_ * touch.wetted;
    if (!(bears > 0)) continue;
    WallAnchor* const before = known.find(touch.vertex, touch.wall);
    if (before == nullptr) {
      state.anchors.push_back({touch.vertex, touch.wall, at.point[0], at.point[1]});  // no force yet
      continue;
    }
    WallAnchor anchor = *before;
    before->holder = -1;  // this contact has not ended
    const double slip = (at.along * (at.point - Eigen::Array2d(anchor.x, anchor.y))).sum();
    const double most = bears / (stiffness_ * at.gradient);
    const double held = yield.hold(anchor, slip, -most, most, stiffness_, purpose);
    if (held != slip) {
      const Eigen::Array2d moved = at.point - held * at.along;
      anchor.x = moved[0];
      anchor.y = moved[1];
    }
    state.anchors.push_back(anchor);
    if (force != nullptr) add_force(anchor, at, *force);
  }
  for (const WallAnchor& anchor : known.all())
    if (anchor.holder >= 0) yield.forget(anchor, stiffness_);
  return yield;
}

}  // namespace clog

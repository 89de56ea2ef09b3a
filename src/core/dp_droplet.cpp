#include "clog/core/dp_droplet.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "clog/core/units.hpp"
#include "dp_kernel.hpp"

namespace clog {
namespace {

/// Contact lists, the frame and the stability bound are looked after once in so many steps.
constexpr int steps_per_check = 32;

}  // namespace

DpDroplet::DpDroplet(const RunParameters& run, const ObstacleArray& obstacles, DropletState initial)
    : run_(run),
      forces_(run, obstacles),
      vertex_mass_(units::droplet_mass / run.dp.vertices),
      force_(2 * run.dp.vertices),
      far_rate_(units::gravity / run.drag.terminal_speed),
      relative_rate_((run.drag.relative - 1) * far_rate_),
      on_area_(run.dp.gravity == Gravity::area),
      drag_rate_(run.drag.near_wall > 0 || run.drag.relative != 1 ? run.dp.vertices : 0) {
  state_ = std::move(initial);
  forces_.update_contacts(state_, state_.possible_travel(steps_per_check * run_.time_step));
  if (on_area_) forces_.set_mean_drag(mean_drag(state_.mean_velocity()));
  forces_.evaluate(state_, force_);
  measure_drag();
}

void DpDroplet::measure_drag() {
  if (drag_rate_.size() == 0) return;
  drag_rate_.setConstant(far_rate_ + relative_rate_);
  if (run_.drag.near_wall > 0)
    drag_rate_ += far_rate_ * run_.drag.near_wall *
                  (units::droplet_diameter / forces_.wall_distance()).pow(run_.drag.near_wall_exponent);
}

Eigen::Array2d DpDroplet::mean_drag(const Eigen::Array2d& velocity) const {
  return -units::droplet_mass * far_rate_ * velocity;
}

double DpDroplet::drag_power() const {
  const Eigen::Index n = run_.dp.vertices;
  const Eigen::ArrayXd speed2 = state_.velocity.head(n).square() + state_.velocity.tail(n).square();
  if (drag_rate_.size() == 0) return vertex_mass_ * far_rate_ * speed2.sum();
  // sum_i of rate_i v_i^2 - e V.v_i, e the relative rate and V the mean velocity.
  return vertex_mass_ * ((drag_rate_ * speed2).sum() -
                         static_cast<double>(n) * relative_rate_ * state_.mean_velocity().square().sum());
}

void DpDroplet::step(double time_step) {
  const int n = run_.dp.vertices;
  const double half_dt_over_m = 0.5 * time_step / vertex_mass_;
  const Eigen::Array2d drift = on_area_ ? state_.mean_velocity() : Eigen::Array2d(0, 0);
  double* x = state_.position.data();
  double* v = state_.velocity.data();
  const double* f = force_.data();
  const kernel::OwnDrag drag{drag_rate_.data(), relative_rate_};
  if (drag_rate_.size() == 0)
    kernel::kick_and_drift(2 * n, 0.5 * time_step * far_rate_, half_dt_over_m, time_step, f, v, x);
  else
    for (const int first : {0, n})
      kernel::kick_and_drift(n, drag, half_dt_over_m, time_step, f + first, v + first, x + first);

  // The mean velocity at the end of the step, to second order, from those at its begin and in its middle.
  if (on_area_) forces_.set_mean_drag(mean_drag(2 * state_.mean_velocity() - drift));
  forces_.evaluate(state_, force_);
  measure_drag();

  if (drag_rate_.size() == 0)
    kernel::kick(2 * n, 0.5 * time_step * far_rate_, half_dt_over_m, f, v);
  else
    for (const int first : {0, n}) kernel::kick(n, drag, half_dt_over_m, time_step, f + first, v + first);
}

void DpDroplet::advance(int num_steps) {
  for (int done = 0; done < num_steps; done += steps_per_check) {
    const int steps = std::min(steps_per_check, num_steps - done);
    if (state_.recentre().any()) forces_.forget_contacts();
    forces_.update_contacts(state_, state_.possible_travel(steps * run_.time_step));
    const StiffModes modes = stiff_modes(run_.dp, *run_.wall_stiffness, forces_.shape().perimeter);
    const int substeps = num_substeps(modes, run_.time_step);
    const double time_step = run_.time_step / substeps;
    for (int i = 0; i < steps * substeps; ++i) {
      if (measures_dissipation_) dissipated_energy_ += 0.5 * time_step * drag_power();
      step(time_step);
      if (measures_dissipation_) dissipated_energy_ += 0.5 * time_step * drag_power();
    }
    num_integrated_steps_ += static_cast<std::int64_t>(steps) * substeps;
  }
}

double DpDroplet::kinetic_energy() const { return 0.5 * vertex_mass_ * state_.velocity.square().sum(); }

}  // namespace clog

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
      is_coupled_(run.dp.gravity == Gravity::area || run.drag.near_wall > 0 || run.drag.relative != 1),
      drag_rate_(Eigen::ArrayXd::Constant(run.dp.vertices, run.drag.relative * far_rate_)) {
  state_ = std::move(initial);
  forces_.update_contacts(state_, state_.possible_travel(steps_per_check * run_.time_step));
  forces_.evaluate(state_, force_);
  measure_drag();
}

void DpDroplet::measure_drag() {
  if (run_.drag.near_wall > 0)
    drag_rate_ = far_rate_ *
                 (run_.drag.relative +
                  run_.drag.near_wall *
                      (units::droplet_diameter / forces_.wall_distance()).pow(run_.drag.near_wall_exponent));
}

/// With the weight on the area, the drag on the droplet's mean motion acts there too, b_inf V_a on the area;
/// on the vertices c b_inf (v_i - V)/N_v remains. Both only ever take energy out.
kernel::CoupledDrag DpDroplet::coupled_drag() {
  const double c = run_.drag.relative;
  const bool on_area = run_.dp.gravity == Gravity::area;
  return {.rate = drag_rate_.data(),
          .relative_rate = (on_area ? c : c - 1) * far_rate_,
          .area_rate = on_area ? far_rate_ : 0,
          .gradient = kernel::centroid_gradient(run_.dp.vertices, forces_.centroid_gradient().data())};
}

double DpDroplet::power_loss() { return drag_power() - forces_.spreading_power(state_); }

double DpDroplet::drag_power() {
  const int n = run_.dp.vertices;
  const double* v = state_.velocity.data();
  const Eigen::ArrayXd speed2 = state_.velocity.head(n).square() + state_.velocity.tail(n).square();
  if (!is_coupled_) return vertex_mass_ * far_rate_ * speed2.sum();
  const kernel::CoupledDrag drag = coupled_drag();
  const kernel::Drift drift = kernel::measure_drift(n, v, v + n, drag.gradient);
  const double mean2 = drift.mean_x * drift.mean_x + drift.mean_y * drift.mean_y;
  const double area2 = drift.area_x * drift.area_x + drift.area_y * drift.area_y;
  return vertex_mass_ *
         ((drag_rate_ * speed2).sum() + n * (drag.area_rate * area2 - drag.relative_rate * mean2));
}

void DpDroplet::step(double time_step) {
  const int n = run_.dp.vertices;
  const double half_dt_over_m = 0.5 * time_step / vertex_mass_;
  double* x = state_.position.data();
  double* v = state_.velocity.data();
  const double* f = force_.data();
  if (is_coupled_) {
    const kernel::CoupledDrag drag = coupled_drag();
    const kernel::Drift drift = kernel::measure_drift(n, v, v + n, drag.gradient);
    kernel::kick_and_drift(n, drag, drift, half_dt_over_m, time_step, f, f + n, v, v + n, x, x + n);
    forces_.evaluate(state_, force_);
    measure_drag();
    kernel::kick(n, drag, half_dt_over_m, time_step, f, f + n, v, v + n);
  } else {
    const double damping = 0.5 * time_step * far_rate_;
    kernel::kick_and_drift(2 * n, damping, half_dt_over_m, time_step, f, v, x);
    forces_.evaluate(state_, force_);
    kernel::kick(2 * n, damping, half_dt_over_m, f, v);
  }
}

void DpDroplet::advance(int num_steps) {
  for (int done = 0; done < num_steps; done += steps_per_check) {
    // Its contact lists would take all memory. The run sees it at its next check.
    if (!(forces_.shape().perimeter < burst_perimeter)) return;
    const int steps = std::min(steps_per_check, num_steps - done);
    if (state_.recentre().any()) forces_.forget_contacts();
    forces_.update_contacts(state_, state_.possible_travel(steps * run_.time_step));
    const StiffModes modes = stiff_modes(run_.dp, *run_.wall_stiffness, forces_.shape().perimeter);
    const int substeps = num_substeps(modes, run_.time_step);
    const double time_step = run_.time_step / substeps;
    for (int i = 0; i < steps * substeps; ++i) {
      const double loss_before = measures_dissipation_ ? power_loss() : 0;
      step(time_step);
      if (measures_dissipation_) dissipated_energy_ += 0.5 * time_step * (loss_before + power_loss());
    }
    num_integrated_steps_ += static_cast<std::int64_t>(steps) * substeps;
  }
}

Eigen::Array2d DpDroplet::centre() const {
  return run_.dp.gravity == Gravity::area ? area_centroid(state_.position) : state_.centre();
}

Eigen::Array2d DpDroplet::centre_velocity() const {
  return run_.dp.gravity == Gravity::area ? area_centroid_velocity(state_.position, state_.velocity)
                                          : state_.mean_velocity();
}

double DpDroplet::kinetic_energy() const { return 0.5 * vertex_mass_ * state_.velocity.square().sum(); }

}  // namespace clog

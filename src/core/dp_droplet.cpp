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
/// Exponent of the near-wall drag, calibrated by Cheng et al. (Appendix A).
constexpr double near_wall_exponent = 4.0 / 3.0;

}  // namespace

DpDroplet::DpDroplet(const RunParameters& run, const ObstacleArray& obstacles, DropletState initial)
    : run_(run),
      forces_(run, obstacles),
      vertex_mass_(units::droplet_mass / run.dp.vertices),
      force_(2 * run.dp.vertices),
      drag_rate_(run.drag.near_wall > 0 ? 2 * run.dp.vertices : 0) {
  state_ = std::move(initial);
  forces_.update_contacts(state_, state_.possible_travel(steps_per_check * run_.time_step));
  forces_.evaluate(state_, force_);
  measure_drag();
}

void DpDroplet::measure_drag() {
  if (drag_rate_.size() == 0) return;
  const Eigen::Index n = run_.dp.vertices;
  const double far_rate = units::gravity / run_.drag.terminal_speed;
  drag_rate_.head(n) =
      far_rate *
      (1 + run_.drag.near_wall * (units::droplet_diameter / forces_.wall_distance()).pow(near_wall_exponent));
  drag_rate_.tail(n) = drag_rate_.head(n);
}

void DpDroplet::step(double time_step) {
  const int n = 2 * run_.dp.vertices;
  const double half_dt_over_m = 0.5 * time_step / vertex_mass_;
  double* x = state_.position.data();
  double* v = state_.velocity.data();
  if (drag_rate_.size() == 0) {
    const double damping = 0.5 * time_step * units::gravity / run_.drag.terminal_speed;
    kernel::kick_and_drift(n, damping, half_dt_over_m, time_step, force_.data(), v, x);
    forces_.evaluate(state_, force_);
    kernel::kick(n, damping, half_dt_over_m, force_.data(), v);
  } else {
    kernel::kick_and_drift(n, drag_rate_.data(), half_dt_over_m, time_step, force_.data(), v, x);
    forces_.evaluate(state_, force_);
    measure_drag();
    kernel::kick(n, drag_rate_.data(), half_dt_over_m, time_step, force_.data(), v);
  }
}

void DpDroplet::advance(int num_steps) {
  for (int done = 0; done < num_steps; done += steps_per_check) {
    const int steps = std::min(steps_per_check, num_steps - done);
    if (state_.recentre().any()) forces_.forget_contacts();
    forces_.update_contacts(state_, state_.possible_travel(steps * run_.time_step));
    const StiffModes modes = stiff_modes(run_.dp, *run_.wall_stiffness, forces_.shape().perimeter);
    const int substeps = num_substeps(modes, run_.time_step);
    for (int i = 0; i < steps * substeps; ++i) step(run_.time_step / substeps);
    num_integrated_steps_ += static_cast<std::int64_t>(steps) * substeps;
  }
}

double DpDroplet::kinetic_energy() const { return 0.5 * vertex_mass_ * state_.velocity.square().sum(); }

}  // namespace clog

#include "clog/core/polygon/step/dp_droplet.hpp"

#include <algorithm>
#include <utility>

#include "clog/core/droplet/time_step.hpp"
#include "clog/core/tools/units.hpp"
#include "dp_stepper.hpp"

namespace clog {
namespace {

/// Contact lists and the stability bound are checked once in so many steps: at most 32, and so few that
/// vertices cannot move far in between, which keeps the lists short.
int steps_between_checks(double time_step) {
  constexpr double longest = 0.04;  // [t0]
  int steps = 32;
  while (steps > 1 && steps * time_step > longest) steps /= 2;
  return steps;
}

/// Whether the drag on vertices that move relative to their mean damps what an implicit pressure feeds into
/// the motion of a droplet that swings (docs/notes/2026-11-26-time-step.md).
bool is_damped(const RunParameters& run) {
  constexpr double most_steps = 32;
  return relaxation_time(run) <= most_steps * run.time_step.value() * std::min(1.0, run.drag.relative);
}

}  // namespace

DpDroplet::DpDroplet(const RunParameters& run, const ObstacleArray& obstacles, DropletState initial)
    : run_(run),
      forces_(run, obstacles),
      vertex_mass_(run.dp.inertia * units::droplet_mass / *run.dp.vertices),
      steps_per_check_(steps_between_checks(run.time_step.value())),
      may_have_implicit_pressure_(is_damped(run) && run.drag.near_wall == 0),
      stepper_(std::make_unique<DpStepper>(run, obstacles, forces_)) {
  state_ = std::move(initial);
  DpDroplet::start_afresh();
}

DpDroplet::~DpDroplet() = default;

void DpDroplet::start_afresh() {
  forces_.forget_all_contacts();
  forces_.update_contacts(state_, state_.possible_travel(steps_per_check_ * run_.time_step.value()));
}

void DpDroplet::advance(int num_steps) {
  if (state_.recentre().any()) forces_.forget_contacts();
  stepper_->load(state_);
  Work* const work = measures_dissipation_ ? &work_ : nullptr;
  for (int done = 0; done < num_steps; done += steps_per_check_) {
    const kernel::Survey now = stepper_->survey();
    // Its contact lists would take all memory. The run sees it at its next check.
    if (!(now.perimeter < burst_perimeter)) break;
    const int steps = std::min(steps_per_check_, num_steps - done);
    const double time = steps * run_.time_step.value();
    const Travel travel{.absolute = possible_way(now.speed, time),
                        .relative = possible_way(now.relative_speed, time)};
    if (!forces_.contacts_hold(now.moved, now.moved_relative, travel)) {
      stepper_->store(state_);
      forces_.update_contacts(state_, travel);
    }
    stepper_->look(state_, travel, now.speed, work);
    const StiffModes modes = stiff_modes(run_.dp, *run_.wall_stiffness, now.perimeter, now.shortest);
    const auto [num, implicit_pressure] =
        stable_steps(modes, steps, run_.time_step.value(), may_have_implicit_pressure_);
    stepper_->advance(state_, num, num == steps ? run_.time_step.value() : time / num, implicit_pressure,
                      work);
    num_integrated_steps_ += num;
  }
  stepper_->finish(state_, work);
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

#include "clog/core/polygon/step/dp_droplet.hpp"

#include <utility>

#include "clog/core/tools/units.hpp"
#include "dp_stepper.hpp"

namespace clog {

DpDroplet::DpDroplet(const RunParameters& run, const ObstacleArray& obstacles, DropletState initial)
    : run_(run),
      forces_(run, obstacles),
      vertex_mass_(run.dp.inertia * units::droplet_mass / *run.dp.vertices),
      stepper_(std::make_unique<DpStepper>(run, obstacles, forces_)) {
  state_ = std::move(initial);
  DpDroplet::rebuild_lists();
}

DpDroplet::~DpDroplet() = default;

void DpDroplet::rebuild_lists() { stepper_->rebuild_lists(state_); }

void DpDroplet::advance(int num_steps) {
  num_integrated_steps_ += stepper_->move(state_, num_steps, measures_dissipation_ ? &work_ : nullptr);
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

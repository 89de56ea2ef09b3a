#include "rest_forces.hpp"

#include <algorithm>
#include <cassert>

#include "clog/core/droplet/shape.hpp"
#include "core/polygon/step/step_input.hpp"

namespace clog {
RestForces::RestForces(const RunParameters& run, DpForces& forces)
    : forces_(&forces),
      n_(*run.dp.vertices),
      terms_(kick_terms(run, 0)),
      kernel_(kernel::step_kernel(terms_)),
      contact_(contact_as_kick(run, forces, 1)),
      memory_(n_),
      plan_(n_),
      wetting_(n_) {}

void RestForces::update_contacts(const DropletState& state, const Travel& travel) {
  memory_.load(state.position, memory_.arrays().position);
  if (!contacts_hold(travel)) look(state, travel);
}

bool RestForces::contacts_hold(const Travel& travel) const {
  return looked_at_.size() > 0 && forces_->has_contact_lists() &&
         kernel_.survey(n_, looked_at_.data(), nullptr, memory_.arrays()).moved + travel.absolute <= way_;
}

void RestForces::look(const DropletState& state, const Travel& travel) {
  way_ = std::max(2 * travel.absolute, 0.3 * forces_->vertex_diameter());
  forces_->update_contacts(state, {.absolute = way_, .relative = 2 * way_});
  looked_at_.setZero(2 * n_ + kernel::edges_per_group);
  looked_at_.head(2 * n_) = state.position;
  const kernel::StepArrays& a = memory_.arrays();
  kernel_.measure(n_, a);
  near_.measure(kernel_, contact_, *forces_, a);
  near_.keep(kernel_, *forces_, refined_sway * way_, 2 * way_);
  plan_.make(near_.walls());
  kernel_.clear_pushes(n_, a);  // the new plan may have other groups than the old one
  wedges_ = wedges_in(state.frame, forces_->wedges());
}

/// Computes the force as the velocity after a kick from rest, without drag. The time of the kick is chosen so
/// that this velocity equals the force.
void RestForces::evaluate(const DropletState& state, Eigen::ArrayXd& force) {
  assert(looked_at_.size() > 0);
  const kernel::StepArrays& a = memory_.arrays();
  memory_.load(state.position, a.position);
  const kernel::Sums sums = kernel_.measure(n_, a);
  if (!wedges_.empty()) kernel_.clear_pushes(n_, a);
  kernel_.push(n_, plan_.windows(), near_.self().data(), near_.self().size(), contact_, a);
  kernel_.push_off_wedges(n_, wedges_.data(), wedges_.size(), forces_->walls().range(), contact_.stiffness,
                          a);
  start_from_forces_of_walls(state, force);
  const kernel::Coupling coupling = kernel_.kick(
      n_, terms_, interface_kick(forces_->interface(sums.area, sums.perimeter), 1),
      area_force(sums, Eigen::Array2d(forces_->weight(), 0) - wetting_.net_spreading),
      {.closing_ratio = 0, .h1 = 0, .h2 = 0, .weight = 1, .half_step = 0, .keeps_kicked = false}, a);
  memory_.store(a.velocity, force);
  if (!terms_.on_area) return;
  for (int i = 0; i < n_; ++i) {
    force[i] = force[i] - coupling.a_x * a.grad_x.x[i] - coupling.a_y * a.grad_y.x[i];
    force[n_ + i] = force[n_ + i] - coupling.a_x * a.grad_x.y[i] - coupling.a_y * a.grad_y.y[i];
  }
}

/// Sets the velocities to the forces of wetted walls and friction, which the kick does not contain.
/// @param force  working memory
void RestForces::start_from_forces_of_walls(const DropletState& state, Eigen::ArrayXd& force) {
  const kernel::StepArrays& a = memory_.arrays();
  const WettedWalls& walls = forces_->wetted_walls();
  if (!walls.is_on() && !forces_->friction().is_on()) {
    std::fill_n(a.velocity.x.first, n_, 0.0);
    std::fill_n(a.velocity.y.first, n_, 0.0);
    return;
  }
  force.setZero();
  if (walls.is_on()) {
    walls.find_forces(VertexPlaces(state), state.frame, state.anchors, wetting_);
    force = wetting_.gradient + wetting_.spreading;
  }
  if (forces_->friction().is_on()) forces_->friction().add_forces(state, force);
  memory_.load(force, a.velocity);
}

}  // namespace clog

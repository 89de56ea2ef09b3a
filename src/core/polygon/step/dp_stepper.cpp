#include "dp_stepper.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "clog/core/droplet/time_step.hpp"
#include "clog/core/tools/units.hpp"
#include "step_input.hpp"

namespace clog {

namespace {

/// The rate of the drag far from walls [1/t0].
double far_rate_of(const RunParameters& run) { return 1 / relaxation_time(run); }

/// See kernel::WallGrip.
double film_reach_of(const RunParameters& run, const DpForces& forces) {
  return run.dp.film_friction == FilmFriction::on
             ? film_reach(forces.walls().range(), forces.self_contacts().range())
             : 0;
}

kernel::KickTerms with_implicit_pressure(kernel::KickTerms terms) {
  terms.implicit_pressure = true;
  return terms;
}

}  // namespace

DpStepper::DpStepper(const RunParameters& run, const ObstacleArray& obstacles, const DpForces& forces)
    : run_(run),
      forces_(&forces),
      terms_(kick_terms(run, far_rate_of(run))),
      kernel_(kernel::step_kernel(terms_)),
      implicit_kernel_(kernel::step_kernel(with_implicit_pressure(terms_))),
      n_(*run.dp.vertices),
      holds_circles_(forces.friction().is_on() && run.dp.wall_contact == WallContact::edge &&
                     obstacles.wedges().empty()),
      memory_(n_),
      arrays_(memory_.arrays()),
      plan_(n_),
      hold_(n_, forces.walls().range(), film_reach_of(run, forces)),
      touches_(run, obstacles),
      wetting_(n_),
      friction_(Eigen::ArrayXd::Zero(Eigen::Index{2} * n_)) {}

void DpStepper::load(const DropletState& state) {
  memory_.load(state.position.data(), arrays_.x);
  memory_.load(state.position.data() + n_, arrays_.y);
  memory_.load(state.velocity.data(), arrays_.vx);
  memory_.load(state.velocity.data() + n_, arrays_.vy);
  wedges_ = wedges_in(state.frame, forces_->wedges());
  sums_ = kernel_.measure(n_, arrays_);
  hold_.forget();
  steps_to_rates_ = 0;
  open_step_ = 0;
}

kernel::Survey DpStepper::survey() const {
  return kernel_.survey(n_, forces_->walls().reference(), forces_->self_contacts().reference(), arrays_);
}

void DpStepper::look(DropletState& state, const Travel& travel, double speed, Droplet::Work* work) {
  fastest_ = speed;
  kernel_.clear_pushes(n_, arrays_);  // the lists may name other groups than before
  // A contact accelerates the vertices in it, by at most half its depth per step, for a few steps. `travel`
  // does not include that.
  constexpr double thrown = 4;
  const double unforeseen =
      0.1 * forces_->vertex_diameter() +
      thrown * near_.measure(kernel_, contact_as_kick(run_, *forces_, 0), *forces_, arrays_);
  near_.keep(kernel_, *forces_, refined_sway * (travel.absolute + unforeseen),
             2 * (travel.relative + unforeseen));
  if (holds_circles_) {
    const WallHold::Near near{near_.walls(), near_.self(), travel.absolute + unforeseen};
    const double lost = forces_->friction().stiffness() * hold_.make(near, arrays_.x, arrays_.y, state);
    if (work != nullptr) work->dissipated += lost;
  } else {
    plan_.make(near_.walls());
  }
}

void DpStepper::store(DropletState& state) const {
  std::copy_n(arrays_.x, n_, state.position.data());
  std::copy_n(arrays_.y, n_, state.position.data() + n_);
  std::copy_n(arrays_.vx, n_, state.velocity.data());
  std::copy_n(arrays_.vy, n_, state.velocity.data() + n_);
}

void DpStepper::advance(DropletState& state, int steps, double time_step, bool implicit_pressure,
                        Droplet::Work* work) {
  has_implicit_pressure_ = implicit_pressure;
  const double h = 0.5 * time_step;
  for (int step = 0; step < steps; ++step) {
    const double h_before = 0.5 * open_step_;
    open_step_ = time_step;
    kick_and_drift(state,
                   {.kicks = h_before / h,
                    .h1 = h_before,
                    .h2 = h,
                    .weight = h_before / h + 1,
                    .half_step = h,
                    .keeps_kicked = work != nullptr,
                    .softening = softening(h)},
                   time_step, work);
  }
}

void DpStepper::finish(DropletState& state, Droplet::Work* work) {
  if (open_step_ != 0) {
    const double h = 0.5 * open_step_;
    kick_and_drift(state,
                   {.kicks = 1,
                    .h1 = h,
                    .h2 = h,
                    .weight = 1,
                    .half_step = h,
                    .keeps_kicked = true,
                    .softening = softening(h)},
                   0, work);
    open_step_ = 0;
  }
  store(state);
  hold_.hand_back(state);
}

/// One force evaluation, the half kicks on its two sides, and the drift to the next one; without a drift only
/// the first half kick.
void DpStepper::kick_and_drift(DropletState& droplet, const kernel::KickCoefficients& coefficients,
                               double drift_time, Droplet::Work* work) {
  const double impulse = coefficients.half_step / vertex_mass();
  push_off_everything(droplet, coefficients, impulse, work);
  const kernel::InterfaceKick interface =
      kernel::kick_of(forces_->interface(sums_.area, sums_.perimeter), impulse);
  const Eigen::Array2d weight{units::droplet_mass * units::gravity, 0};
  const kernel::AreaForce force = area_force(sums_, impulse * (weight - wetting_spread_));
  const kernel::StepKernel& kernel = has_implicit_pressure_ ? implicit_kernel_ : kernel_;
  const kernel::Coupling coupling = kernel.kick(n_, terms_, interface, force, coefficients, arrays_);
  if (work != nullptr) {
    const Droplet::Work now = power(interface, coefficients, coupling);
    if (coefficients.kicks != 0) {  // it ends a step
      work->dissipated += coefficients.h1 * (open_power_.dissipated + now.dissipated);
      work->spreading += coefficients.h1 * (open_power_.spreading + now.spreading);
    }
    open_power_ = now;
  }
  if (drift_time == 0) {  // w, to which no second half kick was added, is the velocity
    std::swap(arrays_.vx, arrays_.kicked_x);
    std::swap(arrays_.vy, arrays_.kicked_y);
  }
  sums_ = kernel.drift(n_, terms_, coefficients, coupling, drift_time, arrays_);
}

void DpStepper::push_off_circles(const kernel::Contact& touching, double impulse, Droplet::Work* work) {
  if (!holds_circles_) {
    kernel_.push(n_, plan_.windows(), near_.self().data(), near_.self().size(), touching, arrays_);
    return;
  }
  const WallFriction& friction = forces_->friction();
  const double taken =
      kernel_.push_and_hold(n_, hold_.circles(),
                            {.coefficient = friction.coefficient(),
                             .traction = impulse * friction.yield_traction(),
                             .stiffness = impulse * friction.stiffness(),
                             .film_reach = hold_.film_reach(),
                             .least_film_push = least_film_push * touching.stiffness * touching.self_range},
                            near_.self().data(), near_.self().size(), touching, arrays_);
  if (work != nullptr) work->dissipated += friction.stiffness() * taken;
}

void DpStepper::push_off_everything(DropletState& droplet, const kernel::KickCoefficients& coefficients,
                                    double impulse, Droplet::Work* work) {
  const kernel::Contact touching = contact_as_kick(run_, *forces_, impulse);
  const bool touches = !near_.walls().empty() || !wedges_.empty() || !droplet.anchors.empty();
  const bool slides = forces_->friction().is_on() && !holds_circles_ && touches;
  // Whatever these add, to vertices beyond the listed groups too, is gone before the next step.
  if (!wedges_.empty() || forces_->wetted_walls().is_on() || slides || are_pushes_spread_)
    kernel_.clear_pushes(n_, arrays_);
  are_pushes_spread_ = slides;
  push_off_circles(touching, impulse, work);
  if (!wedges_.empty())
    kernel_.push_off_wedges(n_, wedges_.data(), wedges_.size(), forces_->walls().range(), touching.stiffness,
                            arrays_);
  if (forces_->wetted_walls().is_on()) add_wetting(droplet, impulse, work);
  if (slides) hold_by_friction(droplet, impulse, work);
  if (terms_.varying_rate) renew_rates(coefficients);
}

/// The near-wall drag. It is kept for a few steps, in which no vertex moves by more than a part of the
/// smallest distance (docs/notes/2026-11-25-rates-of-near-wall-drag.md).
void DpStepper::renew_rates(const kernel::KickCoefficients& coefficients) {
  constexpr double part = 0.2, most_steps = 4;
  const bool are_known =
      steps_to_rates_ > 0 && coefficients.h1 == rates_for_.h1 && coefficients.h2 == rates_for_.h2;
  if (are_known) {
    --steps_to_rates_;
    return;
  }
  const double way = fastest_ * 2 * coefficients.half_step;  // of the fastest vertex in a step
  steps_to_rates_ = static_cast<int>(std::min(most_steps, 1 + part * run_.drag.near_wall_cutoff / way)) - 1;
  rates_for_ = coefficients;
  const WallContacts& nearest = forces_->nearest_walls();
  kernel_.near_wall_rates(n_,
                          {.items = nearest.items().data(),
                           .num_items = nearest.items().size(),
                           .range = nearest.range(),
                           .alike = nearest.radii_are_equal(),
                           .radius = nearest.largest_radius(),
                           .wedges = wedges_.data(),
                           .num_wedges = wedges_.size()},
                          {.shortest = run_.drag.near_wall_cutoff,
                           .relative = run_.drag.relative,
                           .near_wall = run_.drag.near_wall,
                           .exponent = run_.drag.near_wall_exponent,
                           .far_rate = far_rate_of(run_)},
                          coefficients, arrays_);
}

void DpStepper::add_wetting(DropletState& droplet, double impulse, Droplet::Work* work) {
  for (const int i : wetting_.vertices) arrays_.wetting_x[i] = arrays_.wetting_y[i] = 0;
  const WallYield yield = forces_->wetted_walls().follow_and_find_forces(
      {n_, arrays_.x, arrays_.y}, droplet.frame, droplet.anchors, wetting_);
  if (work != nullptr) work->dissipated += yield.dissipated;
  wetting_spread_ = wetting_.net_spreading;
  for (const int i : wetting_.vertices) {
    arrays_.wetting_x[i] = impulse * wetting_.spreading[i];
    arrays_.wetting_y[i] = impulse * wetting_.spreading[n_ + i];
    arrays_.push_x[i] += impulse * wetting_.gradient[i] + arrays_.wetting_x[i];
    arrays_.push_y[i] += impulse * wetting_.gradient[n_ + i] + arrays_.wetting_y[i];
  }
}

/// Walls yield where they have to, and hold the vertices by what they bear.
void DpStepper::hold_by_friction(DropletState& droplet, double impulse, Droplet::Work* work) {
  const std::vector<WallTouch>& touches =
      touches_.find({n_, arrays_.x, arrays_.y}, droplet.frame, near_.walls(), forces_->self_contacts());
  const WallYield yield =
      forces_->friction().follow(droplet, touches, Purpose::motion, touches_.known_anchors(), &friction_);
  if (work != nullptr) work->dissipated += yield.dissipated;
  for (const WallAnchor& anchor : droplet.anchors) {  // if a vertex has two, the first adds both forces
    const Eigen::Index x = anchor.holder, y = n_ + x;
    arrays_.push_x[x] += impulse * std::exchange(friction_[x], 0.0);
    arrays_.push_y[x] += impulse * std::exchange(friction_[y], 0.0);
  }
}

double DpStepper::softening(double half_step) const {
  return run_.dp.area_stiffness.value() * half_step * half_step / vertex_mass();
}

double DpStepper::vertex_mass() const { return run_.dp.inertia * units::droplet_mass / n_; }

/// The power of the drag and of the springs along the interface at the end of a time step.
Droplet::Work DpStepper::power(const kernel::InterfaceKick& interface,
                               const kernel::KickCoefficients& coefficients,
                               const kernel::Coupling& coupling) const {
  const kernel::Power vertices = kernel_.power(n_, terms_, interface, coefficients, coupling, arrays_);
  const double mean2 = coupling.mean_x * coupling.mean_x + coupling.mean_y * coupling.mean_y;
  const double area2 = coupling.area_x * coupling.area_x + coupling.area_y * coupling.area_y;
  const double reaction = vertices.spread_x * coupling.area_x + vertices.spread_y * coupling.area_y;
  return {.dissipated = vertex_mass() *
                        (vertices.drag + n_ * (terms_.area_rate * area2 - terms_.relative_rate * mean2)),
          .spreading = vertex_mass() / coefficients.half_step * (vertices.spreading - reaction)};
}

}  // namespace clog

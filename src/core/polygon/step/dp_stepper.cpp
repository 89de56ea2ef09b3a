#include "dp_stepper.hpp"

#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

#include "clog/core/droplet/time_step.hpp"
#include "clog/core/tools/units.hpp"
#include "step_input.hpp"

namespace clog {

namespace {

/// The rate of the drag far from walls [1/t0].
double far_rate_of(const RunParameters& run) { return 1 / relaxation_time(run); }

kernel::KickTerms with_implicit_pressure(kernel::KickTerms terms) {
  terms.implicit_pressure = true;
  return terms;
}

/// Surveys are frequent, so that vertices move little between them and the lists stay short.
int steps_between_surveys(double time_step) {
  constexpr double longest = 0.04;  // [t0]
  int steps = most_steps_per_survey;
  while (steps > 1 && steps * time_step > longest) steps /= 2;
  return steps;
}

/// An implicit pressure adds energy to the oscillations of a droplet. It is allowed only if the drag on the
/// relative motion of vertices dissipates this energy (docs/notes/2026-11-26-time-step.md).
Pressure most_pressure(const RunParameters& run) {
  constexpr double most_steps = 32;
  const bool is_damped =
      relaxation_time(run) <= most_steps * run.time_step.value() * std::min(1.0, run.drag.relative);
  return is_damped && run.drag.near_wall == 0 ? Pressure::implicit : Pressure::present;
}

}  // namespace

DpStepper::DpStepper(const RunParameters& run, const ObstacleArray& obstacles, DpForces& forces)
    : run_(run),
      forces_(&forces),
      n_(*run.dp.vertices),
      holds_circles_(forces.friction().is_on() && run.dp.wall_contact == WallContact::edge &&
                     obstacles.wedges().empty()),
      steps_per_survey_(steps_between_surveys(run.time_step.value())),
      most_pressure_(most_pressure(run)),
      terms_(kick_terms(run, far_rate_of(run))),
      kernel_(kernel::step_kernel(terms_)),
      implicit_kernel_(kernel::step_kernel(with_implicit_pressure(terms_))),
      memory_(n_),
      near_{.plan = WallPlan(n_), .hold = WallHold(n_, forces.walls().range())},
      wetting_(n_),
      friction_{.touches = WallTouches(run, obstacles), .force = Eigen::ArrayXd::Zero(Eigen::Index{2} * n_)} {
}

void DpStepper::rebuild_lists(const DropletState& state) {
  forces_->forget_all_contacts();
  forces_->update_contacts(state, state.possible_travel(steps_per_survey_ * run_.time_step.value()));
}

std::int64_t DpStepper::move(DropletState& state, int num_steps, Droplet::Work* work) {
  std::int64_t num_taken = 0;
  load(state);
  for (int done = 0; done < num_steps; done += steps_per_survey_) {
    const kernel::Survey now = survey();
    // The contact lists of a burst droplet would take all memory. The run detects the burst at its next
    // check.
    if (!(now.perimeter < burst_perimeter)) break;
    const int steps = std::min(steps_per_survey_, num_steps - done);
    prepare_contacts(state, now, steps * run_.time_step.value(), work);
    const StiffModes modes = stiff_modes(run_.dp, *run_.wall_stiffness, now.perimeter, now.shortest);
    Steps stable = stable_steps(modes, steps, run_.time_step.value(), most_pressure_);
    const int parts =
        near_.contacts.self().empty() ? 1 : parts_of_fast_step(now.relative_speed * stable.length);
    stable.num *= parts;
    stable.length /= parts;
    advance(state, stable, work);
    num_taken += stable.num;
  }
  finish(state, work);
  return num_taken;
}

/// The number of parts into which a step is split if vertices may move by `way` relative to each other in
/// this step. Otherwise a vertex that moves farther than the range of self-contact in one step would pass
/// through other parts of the interface before they push it.
int DpStepper::parts_of_fast_step(double way) const {
  constexpr double farthest = 0.25;  // in units of the range of self-contact
  constexpr double most_parts = 16;
  const double parts = std::ceil(way / (farthest * forces_->self_contacts().range()));
  return static_cast<int>(std::clamp(parts, 1.0, most_parts));
}

void DpStepper::move(DropletState& state, std::span<const Steps> all, Droplet::Work* work) {
  load(state);
  for (const Steps& steps : all) {
    prepare_contacts(state, survey(), steps.num * steps.length, work);
    advance(state, steps, work);
  }
  finish(state, work);
}

/// Copies the droplet's positions and velocities into the arrays of the step.
void DpStepper::load(DropletState& state) {
  if (state.recentre().any()) forces_->forget_contacts();
  const kernel::StepArrays& a = memory_.arrays();
  memory_.load(state.position, a.position);
  memory_.load(state.velocity, a.velocity);
  near_.wedges = wedges_in(state.frame, forces_->wedges());
  sums_ = kernel_.measure(n_, a);
  near_.hold.forget();
  rates_.steps_left = 0;
  open_.length = 0;
}

kernel::Survey DpStepper::survey() const {
  return kernel_.survey(n_, forces_->walls().reference(), forces_->self_contacts().reference(),
                        memory_.arrays());
}

/// Rebuilds the contact lists if they would become invalid within this time. Then selects the possible
/// contacts from the lists.
void DpStepper::prepare_contacts(DropletState& state, const kernel::Survey& now, double time,
                                 Droplet::Work* work) {
  const kernel::StepArrays& a = memory_.arrays();
  const Travel travel{.absolute = possible_distance(now.speed, time),
                      .relative = possible_distance(now.relative_speed, time)};
  if (!forces_->contacts_hold(now.moved, now.moved_relative, travel)) {
    memory_.store(a.position, state.position);
    memory_.store(a.velocity, state.velocity);
    forces_->update_contacts(state, travel);
  }
  rates_.fastest = now.speed;
  fastest_relative_ = now.relative_speed;
  kernel_.clear_pushes(n_, a);  // the new lists may contain other groups than the old ones
  // A contact accelerates its vertices. For a few steps, vertices may therefore move farther by up to half of
  // the contact's depth in each step. `travel` does not include this distance.
  constexpr double thrown = 4;
  const double unforeseen =
      0.1 * forces_->vertex_diameter() +
      thrown * near_.contacts.measure(kernel_, contact_as_kick(run_, *forces_, 0), *forces_, a);
  near_.largest_wall_gap = refined_sway * (travel.absolute + unforeseen);
  near_.largest_self_gap = 2 * (travel.relative + unforeseen);
  crossings_.rebuild(contour(), state.crossings);
  keep_near_contacts();
  if (holds_circles_) {
    const double lost = forces_->friction().stiffness() * near_.hold.make(near_.contacts.walls(), state);
    if (work != nullptr) work->dissipated += lost;
  } else {
    near_.plan.make(near_.contacts.walls());
  }
}

void DpStepper::keep_near_contacts() {
  near_.contacts.keep(kernel_, *forces_, near_.largest_wall_gap, near_.largest_self_gap);
  near_.contacts.mute(crossings_.muted(), n_);
}

/// On return, the last half kick is still pending: the positions belong to the end of the steps, the
/// velocities to a time half a step earlier.
void DpStepper::advance(DropletState& state, const Steps& steps, Droplet::Work* work) {
  assert(forces_->has_contact_lists());
  assert(run_.drag.near_wall == 0 || steps.pressure == Pressure::present);
  open_.pressure = steps.pressure;
  for (int step = 0; step < steps.num; ++step) kick_and_drift(state, 0.5 * steps.length, steps.length, work);
}

/// Makes the last half kick, and copies positions and velocities back to the droplet.
void DpStepper::finish(DropletState& state, Droplet::Work* work) {
  if (open_.length != 0) kick_and_drift(state, 0.5 * open_.length, 0, work);
  memory_.store(memory_.arrays().position, state.position);
  memory_.store(memory_.arrays().velocity, state.velocity);
  near_.hold.hand_back(state);
}

/// Evaluates the forces once. Then makes the half kick that ends a step and the half kick that begins the
/// next step, and drifts to the next evaluation. Without a drift, makes only the half kick that ends a step.
void DpStepper::kick_and_drift(DropletState& state, double half_step, double drift_time,
                               Droplet::Work* work) {
  kernel::StepArrays& a = memory_.arrays();
  const double h_before = 0.5 * open_.length, closing_ratio = h_before / half_step;
  const bool only_closes = drift_time == 0;
  assert(half_step > 0 && (open_.length != 0 || !only_closes));
  const kernel::KickCoefficients coefficients{
      .closing_ratio = closing_ratio,
      .h1 = h_before,
      .h2 = half_step,
      .weight = closing_ratio + (only_closes ? 0 : 1),
      .half_step = half_step,
      .keeps_kicked = only_closes || work != nullptr,
      .softening = run_.dp.area_stiffness.value() * half_step * half_step / vertex_mass()};
  const double impulse = half_step / vertex_mass();
  push_off_everything(state, coefficients, impulse, work);
  const kernel::InterfaceKick interface =
      interface_kick(forces_->interface(sums_.area, sums_.perimeter), impulse);
  const Eigen::Array2d weight{units::droplet_mass * units::gravity, 0};
  const kernel::AreaForce force = area_force(sums_, impulse * (weight - wetting_.net_spreading));
  const kernel::StepKernel& kernel = open_.pressure == Pressure::implicit ? implicit_kernel_ : kernel_;
  const kernel::Coupling coupling = kernel.kick(n_, terms_, interface, force, coefficients, a);
  if (work != nullptr) {
    const Droplet::Work now = power(kernel, interface, coefficients, coupling);
    if (open_.length != 0) {
      work->dissipated += h_before * (open_.power.dissipated + now.dissipated);
      work->spreading += h_before * (open_.power.spreading + now.spreading);
    }
    open_.power = now;
  }
  if (only_closes)
    std::swap(a.velocity, a.kicked);  // the last half kick leaves the new velocities in `kicked`
  sums_ = kernel.drift(n_, terms_, coefficients, coupling, drift_time, a);
  open_.length = drift_time;
}

/// Returns the smallest distance of a listed pair of self-contact [sigma].
double DpStepper::push_off_circles(const kernel::Contact& touching, double impulse, Droplet::Work* work) {
  const std::vector<SelfContacts::Item>& self = near_.contacts.self();
  if (!holds_circles_)
    return kernel_.push(n_, near_.plan.windows(), self.data(), self.size(), touching, memory_.arrays());
  const WallFriction& friction = forces_->friction();
  const kernel::Held held = kernel_.push_and_hold(
      n_, near_.hold.circles(),
      {.coefficient = friction.coefficient(),
       .coefficient_of_layers = run_.dp.film_friction == FilmFriction::on ? friction.coefficient() : 0,
       .traction = impulse * friction.yield_traction(),
       .stiffness = impulse * friction.stiffness()},
      self.data(), self.size(), touching, memory_.arrays());
  if (work != nullptr) work->dissipated += friction.stiffness() * held.taken;
  return held.nearest_pair;
}

Contour DpStepper::contour() const {
  return {n_, memory_.arrays().position.x.first, memory_.arrays().position.y.first};
}

/// Finds the vertices that passed through edges in the last drift. Returns whether the muted contacts have
/// changed.
bool DpStepper::follow_crossings(DropletState& state, double nearest_pair) {
  // After a vertex has just passed through an edge, its distance from the edge is at most the distance that
  // both have moved in the drift. Vertices may have become faster since the last survey; the factor `faster`
  // allows for this. Neighbours along the contour are not in the lists, but they pass through each other's
  // edges only in folds that close fast.
  constexpr double faster = 3, fast = 0.3;
  const double way = 2 * fastest_relative_ * open_.length;
  const bool may_have_passed = faster * way >= nearest_pair || way >= fast * forces_->self_contacts().range();
  if (run_.dp.self_contact == SelfContact::off || open_.length == 0 ||
      (!may_have_passed && state.crossings.empty()))
    return false;
  const kernel::ContourPair& velocity = memory_.arrays().velocity;
  return crossings_.follow(contour(), {velocity.x.first, velocity.y.first, open_.length},
                           forces_->self_contacts(), state);
}

void DpStepper::push_back_crossed(const kernel::Contact& touching) {
  const kernel::ContourPair& push = memory_.arrays().push;
  crossings_.find_pushes(contour(), forces_->self_contacts());
  for (const auto& [vertex, force] : crossings_.pushes()) {
    push.x[vertex] += touching.stiffness * force[0];
    push.y[vertex] += touching.stiffness * force[1];
  }
}

void DpStepper::push_off_everything(DropletState& state, const kernel::KickCoefficients& coefficients,
                                    double impulse, Droplet::Work* work) {
  const kernel::Contact touching = contact_as_kick(run_, *forces_, impulse);
  const std::vector<kernel::WedgePlace>& wedges = near_.wedges;
  const bool touches = !near_.contacts.walls().empty() || !wedges.empty() || !state.anchors.empty();
  const bool slides = forces_->friction().is_on() && !holds_circles_ && touches;
  // Friction and wetted walls also push vertices outside the listed groups, so all pushes are cleared here.
  if (!wedges.empty() || forces_->wetted_walls().is_on() || slides || friction_.has_pushed)
    kernel_.clear_pushes(n_, memory_.arrays());
  friction_.has_pushed = slides;
  const double nearest_pair = push_off_circles(touching, impulse, work);
  if (follow_crossings(state, nearest_pair)) {
    keep_near_contacts();
    kernel_.clear_pushes(n_, memory_.arrays());
    push_off_circles(touching, impulse, work);
  }
  if (!state.crossings.empty()) push_back_crossed(touching);
  kernel_.push_off_wedges(n_, wedges.data(), wedges.size(), forces_->walls().range(), touching.stiffness,
                          memory_.arrays());
  if (forces_->wetted_walls().is_on()) add_wetting(state, impulse, work);
  if (slides) hold_by_friction(state, impulse, work);
  if (terms_.varying_rate) update_rates(coefficients);
}

/// Computes the near-wall drag, unless it is still valid (see most_steps_per_rate).
void DpStepper::update_rates(const kernel::KickCoefficients& coefficients) {
  if (rates_.steps_left > 0 && coefficients.h1 == rates_.h1 && coefficients.h2 == rates_.h2) {
    --rates_.steps_left;
    return;
  }
  const double way = rates_.fastest * 2 * coefficients.half_step;  // distance of the fastest vertex in a step
  const double steps = 1 + farthest_move_per_rate * run_.drag.near_wall_cutoff / way;
  rates_.steps_left = static_cast<int>(std::min(most_steps_per_rate, steps)) - 1;
  rates_.h1 = coefficients.h1;
  rates_.h2 = coefficients.h2;
  const WallContacts& nearest = forces_->nearest_walls();
  kernel_.near_wall_rates(n_,
                          {.items = nearest.items().data(),
                           .num_items = nearest.items().size(),
                           .range = nearest.range(),
                           .alike = nearest.radii_are_equal(),
                           .radius = nearest.largest_radius(),
                           .wedges = near_.wedges.data(),
                           .num_wedges = near_.wedges.size()},
                          {.shortest = run_.drag.near_wall_cutoff,
                           .relative = run_.drag.relative,
                           .near_wall = run_.drag.near_wall,
                           .exponent = run_.drag.near_wall_exponent,
                           .far_rate = far_rate_of(run_)},
                          coefficients, memory_.arrays());
}

void DpStepper::add_wetting(DropletState& state, double impulse, Droplet::Work* work) {
  const kernel::StepArrays& a = memory_.arrays();
  for (const int i : wetting_.vertices) a.wetting.x[i] = a.wetting.y[i] = 0;
  const WallYield yield = forces_->wetted_walls().follow_and_find_forces(
      {n_, a.position.x.first, a.position.y.first}, state.frame, state.anchors, wetting_);
  if (work != nullptr) work->dissipated += yield.dissipated;
  for (const int i : wetting_.vertices) {
    a.wetting.x[i] = impulse * wetting_.spreading[i];
    a.wetting.y[i] = impulse * wetting_.spreading[n_ + i];
    a.push.x[i] += impulse * wetting_.gradient[i] + a.wetting.x[i];
    a.push.y[i] += impulse * wetting_.gradient[n_ + i] + a.wetting.y[i];
  }
}

/// Lets the interface slip along walls whose forces would exceed their limits. The vertices then feel the
/// limiting force.
void DpStepper::hold_by_friction(DropletState& state, double impulse, Droplet::Work* work) {
  const kernel::StepArrays& a = memory_.arrays();
  const std::vector<WallTouch>& touches = friction_.touches.find({n_, a.position.x.first, a.position.y.first},
                                                                 state.frame, near_.contacts.walls());
  const WallYield yield = forces_->friction().follow(state, touches, Purpose::motion,
                                                     friction_.touches.known_anchors(), &friction_.force);
  if (work != nullptr) work->dissipated += yield.dissipated;
  for (const WallAnchor& anchor : state.anchors) {  // `force` contains the sum over all anchors of a vertex,
                                                    // so only the first anchor adds it
    const Eigen::Index x = anchor.holder, y = n_ + x;
    a.push.x[x] += impulse * std::exchange(friction_.force[x], 0.0);
    a.push.y[x] += impulse * std::exchange(friction_.force[y], 0.0);
  }
}

double DpStepper::vertex_mass() const { return run_.dp.inertia * units::droplet_mass / n_; }

/// The power of the drag and of the springs along the interface at the end of a time step.
Droplet::Work DpStepper::power(const kernel::StepKernel& kernel, const kernel::InterfaceKick& interface,
                               const kernel::KickCoefficients& coefficients,
                               const kernel::Coupling& coupling) const {
  assert(coefficients.keeps_kicked);
  const kernel::Power vertices =
      kernel.power(n_, terms_, interface, coefficients, coupling, memory_.arrays());
  const double mean2 = coupling.mean_x * coupling.mean_x + coupling.mean_y * coupling.mean_y;
  const double area2 = coupling.area_x * coupling.area_x + coupling.area_y * coupling.area_y;
  const double reaction = vertices.spread_x * coupling.area_x + vertices.spread_y * coupling.area_y;
  return {.dissipated = vertex_mass() *
                        (vertices.drag + n_ * (terms_.area_rate * area2 - terms_.relative_rate * mean2)),
          .spreading = vertex_mass() / coefficients.half_step * (vertices.spreading - reaction)};
}

}  // namespace clog

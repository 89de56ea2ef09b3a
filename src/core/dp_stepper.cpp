#include "dp_stepper.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "clog/core/units.hpp"

namespace clog {

DpStepper::DpStepper(const RunParameters& run, const DpForces& forces)
    : run_(run), forces_(&forces), kernel_(kernel::step_kernel()), n_(run.dp.vertices) {
  // Every array on a cache line, with room for an entry before and a group behind it.
  constexpr int line = 8;
  const int stride = (n_ + line - 1) / line * line + 3 * line;
  memory_ = hwy::AllocateAligned<double>(static_cast<std::size_t>(kernel::num_step_arrays) * stride);
  std::fill_n(memory_.get(), static_cast<std::size_t>(kernel::num_step_arrays) * stride, 0.0);
  double* next = memory_.get() + line;
  for (double** array :
       {&arrays_.x, &arrays_.y, &arrays_.vx, &arrays_.vy, &arrays_.tangent_x, &arrays_.tangent_y,
        &arrays_.length, &arrays_.push_x, &arrays_.push_y, &arrays_.grad_xx, &arrays_.grad_xy,
        &arrays_.grad_yx, &arrays_.grad_yy, &arrays_.rate, &arrays_.damping, &arrays_.kept, &arrays_.kicked_x,
        &arrays_.kicked_y}) {
    *array = next;
    next += stride;
  }
  const double far_rate = units::gravity / run.drag.terminal_speed;
  const bool on_area = run.dp.gravity == Gravity::area;
  terms_ = {.elastic = run.dp.perimeter_spring != PerimeterSpring::along,
            .on_area = on_area,
            .varying_rate = run.drag.near_wall > 0,
            .coupled = on_area || run.drag.relative != 1,
            .rate = run.drag.near_wall > 0 ? 0 : far_rate * run.drag.relative,
            .relative_rate = (on_area ? run.drag.relative : run.drag.relative - 1) * far_rate,
            .area_rate = on_area ? far_rate : 0};
  if (terms_.varying_rate)
    distance_ =
        Eigen::ArrayXd::Constant(n_ + kernel::edges_per_group, std::numeric_limits<double>::infinity());
}

DpStepper::Edges DpStepper::load(const DropletState& state) {
  const auto copy = [this](const double* from, double* to) {
    std::copy_n(from, n_, to);
    to[-1] = to[n_ - 1];
    std::copy_n(to, kernel::edges_per_group, to + n_);
  };
  copy(state.position.data(), arrays_.x);
  copy(state.position.data() + n_, arrays_.y);
  copy(state.velocity.data(), arrays_.vx);
  copy(state.velocity.data() + n_, arrays_.vy);
  kernel_.clear_pushes(n_, arrays_);  // the lists may name other groups than before
  sums_ = kernel_.measure(n_, arrays_);
  return {.perimeter = sums_.perimeter,
          .shortest = Eigen::Map<const Eigen::ArrayXd>(arrays_.length, n_).minCoeff()};
}

void DpStepper::store(DropletState& state) const {
  std::copy_n(arrays_.x, n_, state.position.data());
  std::copy_n(arrays_.y, n_, state.position.data() + n_);
  std::copy_n(arrays_.vx, n_, state.velocity.data());
  std::copy_n(arrays_.vy, n_, state.velocity.data() + n_);
}

void DpStepper::advance(DropletState& state, int steps, double time_step, Droplet::Work* work) {
  const double h = 0.5 * time_step;
  const bool measures = work != nullptr;
  const kernel::KickCoefficients first{
      .kicks = 0, .h1 = 0, .h2 = h, .weight = 1, .half_step = h, .keeps_kicked = measures};
  const kernel::KickCoefficients inner{
      .kicks = 1, .h1 = h, .h2 = h, .weight = 2, .half_step = h, .keeps_kicked = measures};
  const kernel::KickCoefficients last{
      .kicks = 1, .h1 = h, .h2 = h, .weight = 1, .half_step = h, .keeps_kicked = true};
  Droplet::Work power = kick_and_drift(state, first, time_step, measures);
  for (int step = 1; step <= steps; ++step) {
    const Droplet::Work next = step < steps ? kick_and_drift(state, inner, time_step, measures)
                                            : kick_and_drift(state, last, 0, measures);
    if (measures) {
      work->dissipated += h * (power.dissipated + next.dissipated);
      work->spreading += h * (power.spreading + next.spreading);
    }
    power = next;
  }
  store(state);
}

/// One force evaluation, the half kicks on its two sides, and the drift to the next one; without a drift only
/// the first half kick. Returns the power loss between the two half kicks, if it is wanted.
Droplet::Work DpStepper::kick_and_drift(const DropletState& frame,
                                        const kernel::KickCoefficients& coefficients, double drift_time,
                                        bool measures_power) {
  const double impulse = coefficients.half_step / (units::droplet_mass / n_);
  push_off_everything(frame, coefficients, impulse);
  const kernel::Interface at_rest = forces_->interface(sums_.area, sums_.perimeter);
  const kernel::InterfaceKick interface {
    .line_tension = impulse * (at_rest.line_tension - at_rest.spring * at_rest.spring_length),
    .spring = impulse * at_rest.spring, .spreading = impulse * at_rest.spreading,
    .half_pressure = 0.5 * impulse * at_rest.pressure, .vertex_weight = impulse * at_rest.vertex_weight
  };
  const kernel::AreaForce force{.area = sums_.area,
                                .centre_x = sums_.moment_x / sums_.area,
                                .centre_y = sums_.moment_y / sums_.area,
                                .x = impulse * (units::droplet_mass * units::gravity - wetting_spread_[0]),
                                .y = -impulse * wetting_spread_[1]};
  const kernel::Coupling coupling = kernel_.kick(n_, terms_, interface, force, coefficients, arrays_);
  const Droplet::Work now = measures_power ? power(coefficients, coupling) : Droplet::Work{};
  if (drift_time == 0) {  // w, to which no second half kick was added, is the velocity
    std::swap(arrays_.vx, arrays_.kicked_x);
    std::swap(arrays_.vy, arrays_.kicked_y);
  }
  sums_ = kernel_.drift(n_, terms_, coefficients, coupling, drift_time, arrays_);
  return now;
}

void DpStepper::push_off_everything(const DropletState& frame, const kernel::KickCoefficients& coefficients,
                                    double impulse) {
  const WallContacts& walls = forces_->walls();
  const double stiffness = impulse * forces_->contact_stiffness();
  const SelfContacts& self = forces_->self_contacts();
  const std::vector<Wedge>& wedges = forces_->wedges();
  if (!wedges.empty() || forces_->wets()) kernel_.clear_pushes(n_, arrays_);
  kernel_.push(n_, walls.items().data(), walls.items().size(), self.items().data(), self.items().size(),
               {.stiffness = stiffness,
                .span = run_.dp.wall_contact == WallContact::edge ? 1.0 : 0.0,
                .diameter = self.diameter()},
               arrays_);
  for (const Wedge& wedge : wedges)
    kernel::add_wedge_forces(n_, arrays_.x, arrays_.y, kernel::place_in(frame.frame, wedge), walls.range(),
                             stiffness, arrays_.push_x, arrays_.push_y);
  if (forces_->wets()) {
    DropletState here = frame;
    store(here);
    Eigen::ArrayXd force = Eigen::ArrayXd::Zero(2 * n_);
    wetting_spread_ = forces_->add_wetting(here, force);
    for (int i = 0; i < n_; ++i) {
      arrays_.push_x[i] += impulse * force[i];
      arrays_.push_y[i] += impulse * force[n_ + i];
    }
  }
  if (!terms_.varying_rate) return;
  if (!wedges.empty()) distance_.setConstant(std::numeric_limits<double>::infinity());
  for (const Wedge& wedge : wedges)
    kernel::shrink_to_wedge_distance(n_, arrays_.x, arrays_.y, kernel::place_in(frame.frame, wedge),
                                     distance_.data());
  const WallContacts& nearest = forces_->nearest_walls();
  kernel_.near_wall_rates(n_,
                          {.items = nearest.items().data(),
                           .num_items = nearest.items().size(),
                           .range = nearest.range(),
                           .alike = nearest.radii_are_equal(),
                           .radius = nearest.largest_radius(),
                           .other_distance = distance_.data()},
                          {.shortest = forces_->contact_range(),
                           .relative = run_.drag.relative,
                           .near_wall = run_.drag.near_wall,
                           .exponent = run_.drag.near_wall_exponent,
                           .far_rate = units::gravity / run_.drag.terminal_speed},
                          coefficients, arrays_);
}

Droplet::Work DpStepper::power(const kernel::KickCoefficients& coefficients,
                               const kernel::Coupling& coupling) const {
  const double vertex_mass = units::droplet_mass / n_;
  DropletState here;
  here.position.resize(2 * n_);
  here.velocity.resize(2 * n_);
  double loss = 0;
  for (int i = 0; i < n_; ++i) {
    const double rate = terms_.varying_rate ? arrays_.rate[i] : terms_.rate;
    const double s =
        coefficients.h1 > 0 ? 1 / (1 + coefficients.h1 * rate) : 0;  // before a kick: no coupling yet
    const double vx = arrays_.kicked_x[i] + s * (coupling.c_x - arrays_.grad_xx[i] * coupling.a_x -
                                                 arrays_.grad_yx[i] * coupling.a_y);
    const double vy = arrays_.kicked_y[i] + s * (coupling.c_y - arrays_.grad_xy[i] * coupling.a_x -
                                                 arrays_.grad_yy[i] * coupling.a_y);
    loss += rate * (vx * vx + vy * vy);
    here.velocity[i] = vx;
    here.velocity[n_ + i] = vy;
    here.position[i] = arrays_.x[i];
    here.position[n_ + i] = arrays_.y[i];
  }
  const double mean2 = coupling.mean_x * coupling.mean_x + coupling.mean_y * coupling.mean_y;
  const double area2 = coupling.area_x * coupling.area_x + coupling.area_y * coupling.area_y;
  loss += n_ * (terms_.area_rate * area2 - terms_.relative_rate * mean2);
  return {.dissipated = vertex_mass * loss, .spreading = forces_->spreading_power(here)};
}

}  // namespace clog

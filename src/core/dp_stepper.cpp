#include "dp_stepper.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
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
  for (double** array : {&arrays_.x, &arrays_.y, &arrays_.vx, &arrays_.vy, &arrays_.tangent_x,
                         &arrays_.tangent_y, &arrays_.length, &arrays_.push_x, &arrays_.push_y,
                         &arrays_.grad_xx, &arrays_.grad_xy, &arrays_.grad_yx, &arrays_.grad_yy,
                         &arrays_.rate, &arrays_.damping, &arrays_.kicked_x, &arrays_.kicked_y}) {
    *array = next;
    next += stride;
  }
  const double far_rate = units::gravity / run.drag.terminal_speed;
  const bool on_area = run.dp.gravity == Gravity::area;
  terms_ = {.elastic = run.dp.perimeter_spring != PerimeterSpring::along,
            .on_area = on_area,
            .varying_rate = run.drag.near_wall > 0,
            .rate = run.drag.near_wall > 0 ? 0 : far_rate * run.drag.relative,
            .keeps_kicked = false};
  relative_rate_ = (on_area ? run.drag.relative : run.drag.relative - 1) * far_rate;
  area_rate_ = on_area ? far_rate : 0;
  is_coupled_ = relative_rate_ != 0 || area_rate_ != 0;
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
  sums_ = kernel_.measure(n_, terms_.on_area, arrays_);
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
  const double h_over_m = h / (units::droplet_mass / n_);
  const kernel::KickCoefficients first{.h1 = 0, .m1 = 0, .h2 = h, .m2 = h_over_m, .weight = 1};
  const kernel::KickCoefficients inner{.h1 = h, .m1 = h_over_m, .h2 = h, .m2 = h_over_m, .weight = 2};
  const kernel::KickCoefficients last{.h1 = h, .m1 = h_over_m, .h2 = 0, .m2 = 0, .weight = 1};
  const bool measures = work != nullptr;
  terms_.keeps_kicked = measures;
  Droplet::Work power = kick_and_drift(state, first, h, time_step, measures);
  for (int step = 1; step <= steps; ++step) {
    const Droplet::Work next =
        kick_and_drift(state, step < steps ? inner : last, h, step < steps ? time_step : 0, measures);
    if (measures) {
      work->dissipated += h * (power.dissipated + next.dissipated);
      work->spreading += h * (power.spreading + next.spreading);
    }
    power = next;
  }
  store(state);
}

/// One force evaluation, the half kicks on its two sides, and the drift to the next one. Returns the power
/// loss between the two half kicks, if it is wanted.
Droplet::Work DpStepper::kick_and_drift(const DropletState& frame,
                                        const kernel::KickCoefficients& coefficients, double half_step,
                                        double drift_time, bool measures_power) {
  push_off_everything(frame);
  const kernel::Interface at_rest = forces_->interface(sums_.area, sums_.perimeter);
  const kernel::InterfaceCoefficients interface {
    .line_tension = at_rest.line_tension - at_rest.spring * at_rest.spring_length, .spring = at_rest.spring,
    .spreading = at_rest.spreading, .half_pressure = 0.5 * at_rest.pressure,
    .vertex_weight = at_rest.vertex_weight,
    .body_force = units::droplet_mass * units::gravity / (6 * sums_.area),
    .centre_x = sums_.moment_x / sums_.area, .centre_y = sums_.moment_y / sums_.area
  };
  kernel::KickSums sums = kernel_.kick(n_, terms_, interface, coefficients, arrays_);
  sums.spread_x += wetting_spread_[0];
  sums.spread_y += wetting_spread_[1];
  double c[2] = {0, 0}, a[2] = {0, 0};
  Coupling coupling;
  if (is_coupled_) {
    coupling = couple(sums, coefficients);
    c[0] = half_step * relative_rate_ * coupling.mean[0];
    c[1] = half_step * relative_rate_ * coupling.mean[1];
  }
  if (terms_.on_area) {
    // The reaction to the springs along the interface is a force on the area like its drag; in the kick just
    // done it is missing.
    const double unit = 1 / (6 * sums_.area);
    const double drag = half_step * area_rate_ * n_;
    const double impulse = std::max(coefficients.m1, coefficients.m2);
    a[0] = unit * (drag * coupling.area[0] + impulse * sums.spread_x);
    a[1] = unit * (drag * coupling.area[1] + impulse * sums.spread_y);
  }
  const Droplet::Work now = measures_power ? power(coefficients, coupling, c, a) : Droplet::Work{};
  kernel_.drift(n_, terms_, is_coupled_, coefficients, c, a, drift_time, arrays_);
  if (drift_time > 0) sums_ = kernel_.measure(n_, terms_.on_area, arrays_);
  return now;
}

void DpStepper::push_off_everything(const DropletState& frame) {
  const WallContacts& walls = forces_->walls();
  const double stiffness = forces_->contact_stiffness();
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
      arrays_.push_x[i] += force[i];
      arrays_.push_y[i] += force[n_ + i];
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
                          arrays_);
}

// With s_i = 1/(1 + h r_i) and w_i the velocity kicked by the force and the vertex' own drag,
//   v_i = w_i + s_i (e V - b G_i^T V_a),  V = mean v_i,  V_a = sum G_i v_i,
// e and b half a step's relative and area rate: four linear equations for V and V_a, of which V is
// eliminated. They are implicit because the area's part is stiff for a drawn-out droplet, b sum |G_i|^2
// growing with the square of its length and perimeter.
DpStepper::Coupling DpStepper::couple(const kernel::KickSums& sums,
                                      const kernel::KickCoefficients& coefficients) const {
  const double h = coefficients.h1;
  const double e = h * relative_rate_;
  const double s = sums.s / n_;
  const double feedback = 1 / (1 - e * s);
  Eigen::Vector2d mean_w = Eigen::Vector2d(sums.w_x, sums.w_y) / n_;
  if (!terms_.on_area) return {feedback * mean_w, {0, 0}};
  const double unit = 1 / (6 * sums_.area);
  const double b = h * area_rate_ * n_;
  Eigen::Matrix2d g =
      s * Eigen::Matrix2d::Identity();  // sum s G; sum G is the identity: a shift moves the centroid
  if (terms_.varying_rate) g << unit * sums.g_xx, unit * sums.g_xy, unit * sums.g_yx, unit * sums.g_yy;
  Eigen::Matrix2d gg;
  gg << sums.gg_xx, sums.gg_xy, sums.gg_xy, sums.gg_yy;
  gg *= unit * unit;
  const Eigen::Vector2d reaction = -coefficients.m1 * Eigen::Vector2d(sums.spread_x, sums.spread_y);
  mean_w += g.transpose() * reaction / n_;
  const Eigen::Vector2d area_w = unit * Eigen::Vector2d(sums.gw_x, sums.gw_y) + gg * reaction;
  const Eigen::Matrix2d matrix =
      Eigen::Matrix2d::Identity() + b * gg + e * feedback * b / n_ * g * g.transpose();
  const Eigen::Vector2d area = matrix.inverse() * (area_w + e * feedback * g * mean_w);
  return {feedback * (mean_w - b / n_ * g.transpose() * area), area};
}

Droplet::Work DpStepper::power(const kernel::KickCoefficients& coefficients, const Coupling& coupling,
                               const double (&c)[2], const double (&a)[2]) const {
  const double vertex_mass = units::droplet_mass / n_;
  DropletState here;
  here.position.resize(2 * n_);
  here.velocity.resize(2 * n_);
  double loss = 0;
  for (int i = 0; i < n_; ++i) {
    const double rate = terms_.varying_rate ? arrays_.rate[i] : terms_.rate;
    const double s =
        coefficients.h1 > 0 ? 1 / (1 + coefficients.h1 * rate) : 0;  // before a kick: no coupling yet
    const double vx =
        arrays_.kicked_x[i] + s * (c[0] - arrays_.grad_xx[i] * a[0] - arrays_.grad_yx[i] * a[1]);
    const double vy =
        arrays_.kicked_y[i] + s * (c[1] - arrays_.grad_xy[i] * a[0] - arrays_.grad_yy[i] * a[1]);
    loss += rate * (vx * vx + vy * vy);
    here.velocity[i] = vx;
    here.velocity[n_ + i] = vy;
    here.position[i] = arrays_.x[i];
    here.position[n_ + i] = arrays_.y[i];
  }
  loss += n_ * (area_rate_ * coupling.area.squaredNorm() - relative_rate_ * coupling.mean.squaredNorm());
  return {.dissipated = vertex_mass * loss, .spreading = forces_->spreading_power(here)};
}

}  // namespace clog

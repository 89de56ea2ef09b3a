#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/polygon/step/dp_stepper.hpp"
#include "polygon/forces/reference_forces.hpp"

namespace clog::test {

/// Makes the step as the documentation describes it, with one line per formula. The forces come from
/// ReferenceForces.
class ReadableDroplet {
 public:
  ReadableDroplet(const RunParameters& run, const ObstacleArray& obstacles, DropletState initial,
                  Pressure pressure = Pressure::present)
      : run_(run),
        pressure_(pressure),
        n_(*run.dp.vertices),
        forces_(run, obstacles),
        touches_(run, obstacles),
        state_(std::move(initial)),
        force_(2 * n_) {
    forces_.update_contacts(state_, {.absolute = 0.05, .relative = 0.05});
    find_forces();
  }
  const DropletState& state() const { return state_; }

  void step() {
    const double h = *run_.time_step / 2;
    const double h_over_m = h * n_ / units::droplet_mass;
    state_.velocity += h_over_m * force_ + h * drag(state_.velocity) + h * pressed(state_.velocity);
    state_.position += *run_.time_step * state_.velocity;
    find_forces();
    // In the second half kick, the drag depends on the velocity at the end of the kick, which an iteration
    // finds.
    const Eigen::ArrayXd kicked = state_.velocity + h_over_m * force_;
    // Under-relaxation keeps the iteration stable next to a wall.
    for (int i = 0; i < 300; ++i)
      state_.velocity +=
          0.4 * (kicked + h * drag(state_.velocity) + h * pressed(state_.velocity) - state_.velocity);
  }

 private:
  RunParameters run_;
  Pressure pressure_;
  int n_;
  ReferenceForces forces_;
  WallTouches touches_;
  DropletState state_;
  Eigen::ArrayXd force_;
  Eigen::ArrayXd rate_;  // Rate of the drag on each vertex.
  double fastest_ = 0;   // Speed of the fastest vertex when the contacts were last updated.
  int num_evaluations_ = 0, num_kept_ = 0;

  /// Lets the walls that hold the droplet yield, and then finds the forces.
  void find_forces() {
    if (forces_.has_anchors())
      forces_.let_walls_yield(state_, touches_, forces_.walls().items(), Purpose::motion);
    forces_.evaluate(state_, force_);
    if (num_evaluations_ % most_steps_per_survey == 0)
      fastest_ =
          std::sqrt((state_.velocity.head(n_).square() + state_.velocity.tail(n_).square()).maxCoeff());
    // The rates of the drag are computed at the beginning and at the end of the first step. After that each
    // rate is kept for some steps.
    if (num_evaluations_ > 1 && num_kept_ > 0) {
      --num_kept_;
    } else {
      find_rates();
      const double way = fastest_ * *run_.time_step;
      num_kept_ = static_cast<int>(
          std::min(most_steps_per_rate - 1, farthest_move_per_rate * run_.drag.near_wall_cutoff / way));
    }
    ++num_evaluations_;
  }
  void find_rates() {
    const double far = units::gravity / run_.drag.terminal_speed;
    rate_ = Eigen::ArrayXd::Constant(n_, far * run_.drag.relative);
    if (run_.drag.near_wall > 0)
      rate_ += far * run_.drag.near_wall * forces_.wall_distance().pow(-run_.drag.near_wall_exponent);
  }
  /// The deceleration by drag of vertices with these velocities.
  Eigen::ArrayXd drag(const Eigen::ArrayXd& v) {
    const double far = units::gravity / run_.drag.terminal_speed;
    const bool on_area = run_.dp.gravity == Gravity::area;
    const double to_mean = far * (on_area ? run_.drag.relative : run_.drag.relative - 1);
    Eigen::ArrayXd result(2 * n_);
    result << to_mean * v.head(n_).mean() - rate_ * v.head(n_),
        to_mean * v.tail(n_).mean() - rate_ * v.tail(n_);
    if (on_area) result += area_drag(v);
    return result;
  }
  Eigen::ArrayXd area_drag(const Eigen::ArrayXd& v) {
    const double far = units::gravity / run_.drag.terminal_speed;
    const auto g = [this](Eigen::Index k) { return forces_.centroid_gradient().segment(k * n_, n_); };
    const double area_x = (g(0) * v.head(n_) + g(1) * v.tail(n_)).sum();
    const double area_y = (g(2) * v.head(n_) + g(3) * v.tail(n_)).sum();
    Eigen::ArrayXd result(2 * n_);
    result << -far * n_ * (area_x * g(0) + area_y * g(2)), -far * n_ * (area_x * g(1) + area_y * g(3));
    return result;
  }
  /// The acceleration by an implicit pressure. The pressure is -K_a dt^2 times the acceleration of the area
  /// by the forces, by the drag on the area, and by the implicit pressure itself.
  Eigen::ArrayXd pressed(const Eigen::ArrayXd& v) {
    if (pressure_ == Pressure::present) return Eigen::ArrayXd::Zero(force_.size());
    Eigen::ArrayXd gradient(force_.size());  // gradient of the area
    for (int i = 0; i < n_; ++i) {
      const int next = (i + 1) % n_, before = (i + n_ - 1) % n_;
      gradient[i] = (state_.y()[next] - state_.y()[before]) / 2;
      gradient[n_ + i] = (state_.x()[before] - state_.x()[next]) / 2;
    }
    const double mass = units::droplet_mass / n_;
    Eigen::ArrayXd without = force_ / mass;
    if (run_.dp.gravity == Gravity::area) without += area_drag(v);
    const double softening = *run_.dp.area_stiffness * *run_.time_step * *run_.time_step;
    const double pressure =
        -softening * (gradient * without).sum() / (1 + softening * gradient.square().sum() / mass);
    return pressure / mass * gradient;
  }
};

}  // namespace clog::test

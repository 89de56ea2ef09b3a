#include "clog/core/disk/sp_droplet.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "clog/core/tools/units.hpp"

namespace clog {
namespace {

constexpr int most_steps_per_check = 32;
constexpr double contact_range = units::droplet_diameter / 2;
/// Skin of the list of obstacles. A disk moves this far in some hundred steps, so the list is seldom rebuilt.
/// The list is also short.
constexpr double usual_skin = 0.02;  // [sigma]

}  // namespace

SpForces::SpForces(const RunParameters& run, const ObstacleArray& obstacles)
    : obstacles_(&obstacles),
      wall_stiffness_(run.wall_stiffness.value()),
      weight_(units::droplet_mass * units::gravity, 0) {}

void SpForces::update_contacts(const DropletState& state, const Travel& travel) {
  const Eigen::Array2d centre = state.centre();
  if (listed_ && (centre - reference_).matrix().norm() + travel.absolute < skin_) return;
  skin_ = std::clamp(2 * travel.absolute, usual_skin, widest_skin);
  near_.clear();
  reference_ = centre;
  listed_ = true;
  if (!centre.allFinite()) return;  // the disk has diverged; the run detects this at its next check
  obstacles_->gather({state.frame.origin[0], state.frame.origin[1], centre[0], centre[0], centre[1],
                      centre[1], contact_range + skin_},
                     near_);
}

template <class Visit>
void SpForces::visit_wedges(const Eigen::Array2d& place, const LocalFrame& frame, Visit visit) const {
  for (const Wedge& wedge : obstacles_->wedges()) {
    const auto [distance, normal] = distance_to(wedge, frame.global(place) - wedge.centre());
    visit(distance, normal);
  }
}

Eigen::Array2d SpForces::wedge_force(const Eigen::Array2d& place, const LocalFrame& frame) const {
  const double stiffness = contact_stiffness(wall_stiffness_, units::droplet_diameter);
  Eigen::Array2d force(0, 0);
  visit_wedges(place, frame, [&](double distance, const Eigen::Array2d& normal) {
    force += stiffness * std::max(0.0, contact_range - distance) * normal;
  });
  return force;
}

/// Only a root, a division and a few sums form a chain of dependent operations; the processor overlaps this
/// chain with the other operations.
[[gnu::always_inline]] inline Eigen::Array2d SpForces::scaled_force(double scale, const Eigen::Array2d& place,
                                                                    const LocalFrame& frame) const {
  const double stiffness = scale * contact_stiffness(wall_stiffness_, units::droplet_diameter);
  Eigen::Array2d push(0, 0);  // the part of the force that needs a root
  Eigen::Array2d rest = scale * weight_;
  for (const Obstacle& obstacle : near_) {
    const Eigen::Array2d arm = place - Eigen::Array2d(obstacle.x, obstacle.y);
    const double r2 = arm[0] * arm[0] + arm[1] * arm[1];
    const double reach = contact_range + obstacle.radius;
    if (r2 >= reach * reach || r2 == 0) continue;
    push += stiffness * reach * arm / std::sqrt(r2);
    rest -= stiffness * arm;
  }
  if (!obstacles_->wedges().empty()) rest += scale * wedge_force(place, frame);
  return rest + push;
}

Eigen::Array2d SpForces::force_at(const Eigen::Array2d& place, const LocalFrame& frame) const {
  return scaled_force(1, place, frame);
}

void SpForces::evaluate(const DropletState& state, Eigen::ArrayXd& force) const {
  assert(listed_);
  force = force_at(state.position.head<2>(), state.frame);
}

PotentialEnergy SpForces::energy(const DropletState& state) const {
  assert(listed_);
  PotentialEnergy energy;
  energy.gravity = -weight_[0] * state.position[0];
  const auto add_wall = [&](double distance) {
    const double overlap = std::max(0.0, 1 - distance / contact_range);
    energy.wall += 0.5 * wall_stiffness_ * overlap * overlap;
  };
  for (const Obstacle& obstacle : near_) {
    const double distance =
        std::hypot(state.position[0] - obstacle.x, state.position[1] - obstacle.y) - obstacle.radius;
    add_wall(distance);
  }
  visit_wedges(state.position.head<2>(), state.frame,
               [&](double distance, const Eigen::Array2d&) { add_wall(distance); });
  return energy;
}

SpDroplet::SpDroplet(const RunParameters& run, const ObstacleArray& obstacles, DropletState initial)
    : run_(run), forces_(run, obstacles) {
  state_ = std::move(initial);
  SpDroplet::rebuild_lists();
}

void SpDroplet::rebuild_lists() {
  forces_.forget_contacts();
  forces_.update_contacts(state_, state_.possible_travel(run_.time_step.value()));
  force_ = forces_.force_at(state_.position.head<2>(), state_.frame);
}

void SpDroplet::advance(int num_steps) {
  const double dt = run_.time_step.value();
  for (int done = 0, steps = 0; done < num_steps; done += steps) {
    // At long steps and high speeds, checks are more frequent, so that the list of obstacles stays short.
    steps = std::min(most_steps_per_check, num_steps - done);
    while (steps > 1 && state_.possible_travel(steps * dt).absolute > usual_skin) steps /= 2;
    if (state_.recentre().any()) forces_.forget_contacts();
    forces_.update_contacts(state_, state_.possible_travel(steps * dt));
    integrate(steps);
    num_integrated_steps_ += steps;
  }
}

/// Velocity Verlet, M dv/dt = f - b v with the drag of the second half kick implicit: u = (1 - d) v + h f,  x
/// += dt u,  v = (u + h f)/(1 + d),  h = dt/2M,  d = dt b/2M. The loop computes each displacement s = dt u
/// from the previous displacement: s' = keep s + gain f.
void SpDroplet::integrate(int num_steps) {
  const double dt = run_.time_step.value();
  const double h = 0.5 * dt / units::droplet_mass;
  const double d = 0.5 * dt * units::gravity / run_.drag.terminal_speed;
  const double keep = (1 - d) / (1 + d);
  const double gain = dt * h * (keep + 1);
  const auto half_loss = [&](const Eigen::Array2d& velocity) {  // energy lost to drag in half a step
    return d * units::droplet_mass * velocity.square().sum();
  };

  Eigen::Array2d position = state_.position.head<2>();
  Eigen::Array2d velocity = state_.velocity.head<2>();
  Eigen::Array2d step = dt * ((1 - d) * velocity + h * force_);
  for (int i = 0; i < num_steps; ++i) {
    position += step;
    const Eigen::Array2d kick = forces_.scaled_force(gain, position, state_.frame);
    if (measures_dissipation_ || i + 1 == num_steps) {
      if (measures_dissipation_) work_.dissipated += half_loss(velocity);
      force_ = kick / gain;
      velocity = (step / dt + h * force_) / (1 + d);
      if (measures_dissipation_) work_.dissipated += half_loss(velocity);
    }
    step = keep * step + kick;
  }
  state_.position = position;
  state_.velocity = velocity;
}

double SpDroplet::kinetic_energy() const {
  return 0.5 * units::droplet_mass * state_.velocity.square().sum();
}

PolygonShape SpDroplet::shape() const {
  return {.area = units::rest_area, .perimeter = std::numbers::pi * units::droplet_diameter};
}

}  // namespace clog

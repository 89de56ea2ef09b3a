#include "clog/core/sp_droplet.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "clog/core/units.hpp"

namespace clog {
namespace {

constexpr int most_steps_per_check = 32;
constexpr double contact_range = units::droplet_diameter / 2;
constexpr double usual_skin = 0.1;  // [sigma]

}  // namespace

SpForces::SpForces(const RunParameters& run, const ObstacleArray& obstacles)
    : obstacles_(&obstacles),
      wall_stiffness_(run.wall_stiffness.value()),
      weight_(units::droplet_mass * units::gravity) {}

void SpForces::update_contacts(const DropletState& state, const Travel& travel) {
  const Eigen::Array2d centre = state.centre();
  if (listed_ && (centre - reference_).matrix().norm() + travel.absolute < skin_) return;
  skin_ = std::clamp(2 * travel.absolute, usual_skin, widest_skin);
  near_.clear();
  reference_ = centre;
  listed_ = true;
  if (!centre.allFinite()) return;  // a disk that has diverged; the run will see it at its next check
  obstacles_->gather({state.frame.origin[0], state.frame.origin[1], centre[0], centre[0], centre[1],
                      centre[1], contact_range + skin_},
                     near_);
}

template <class Visit>
void SpForces::visit_wedges(const DropletState& state, Visit visit) const {
  for (const Wedge& wedge : obstacles_->wedges()) {
    const auto [distance, normal] =
        distance_to(wedge, state.frame.global(state.position.head<2>()) - wedge.centre());
    visit(distance, normal);
  }
}

void SpForces::evaluate(const DropletState& state, Eigen::ArrayXd& force) const {
  const double stiffness = contact_stiffness(wall_stiffness_, units::droplet_diameter);
  const double x = state.position[0];
  const double y = state.position[1];
  double fx = weight_;
  double fy = 0;
  for (const Obstacle& obstacle : near_) {
    const double dx = x - obstacle.x;
    const double dy = y - obstacle.y;
    const double r2 = dx * dx + dy * dy;
    const double reach = contact_range + obstacle.radius;
    if (r2 >= reach * reach || r2 == 0) continue;
    const double push = stiffness * (reach / std::sqrt(r2) - 1);
    fx += push * dx;
    fy += push * dy;
  }
  visit_wedges(state, [&](double distance, const Eigen::Array2d& normal) {
    const double push = stiffness * std::max(0.0, contact_range - distance);
    fx += push * normal[0];
    fy += push * normal[1];
  });
  force[0] = fx;
  force[1] = fy;
}

PotentialEnergy SpForces::energy(const DropletState& state) const {
  PotentialEnergy energy;
  energy.gravity = -weight_ * state.position[0];
  const auto add_wall = [&](double distance) {
    const double overlap = std::max(0.0, 1 - distance / contact_range);
    energy.wall += 0.5 * wall_stiffness_ * overlap * overlap;
  };
  for (const Obstacle& obstacle : near_) {
    const double distance =
        std::hypot(state.position[0] - obstacle.x, state.position[1] - obstacle.y) - obstacle.radius;
    add_wall(distance);
  }
  visit_wedges(state, [&](double distance, const Eigen::Array2d&) { add_wall(distance); });
  return energy;
}

SpDroplet::SpDroplet(const RunParameters& run, const ObstacleArray& obstacles, DropletState initial)
    : run_(run), forces_(run, obstacles), force_(2) {
  state_ = std::move(initial);
  forces_.update_contacts(state_, state_.possible_travel(run_.time_step));
  forces_.evaluate(state_, force_);
}

void SpDroplet::advance(int num_steps) {
  const double dt = run_.time_step;
  const double half_dt_over_m = 0.5 * dt / units::droplet_mass;
  const double damping = 0.5 * dt * units::gravity / run_.drag.terminal_speed;
  for (int done = 0, steps = 0; done < num_steps; done += steps) {
    // Large steps and high speeds are looked after more often, so that the list of obstacles stays short.
    steps = std::min(most_steps_per_check, num_steps - done);
    while (steps > 1 && state_.possible_travel(steps * dt).absolute > usual_skin) steps /= 2;
    if (state_.recentre().any()) forces_.forget_contacts();
    forces_.update_contacts(state_, state_.possible_travel(steps * dt));
    const auto half_loss = [&] {  // of the drag in half a step
      return 0.5 * dt * units::droplet_mass * units::gravity / run_.drag.terminal_speed *
             state_.velocity.square().sum();
    };
    for (int i = 0; i < steps; ++i) {
      if (measures_dissipation_) work_.dissipated += half_loss();
      state_.velocity = state_.velocity * (1 - damping) + force_ * half_dt_over_m;
      state_.position += dt * state_.velocity;
      forces_.evaluate(state_, force_);
      state_.velocity = (state_.velocity + force_ * half_dt_over_m) / (1 + damping);
      if (measures_dissipation_) work_.dissipated += half_loss();
    }
    num_integrated_steps_ += steps;
  }
}

double SpDroplet::kinetic_energy() const {
  return 0.5 * units::droplet_mass * state_.velocity.square().sum();
}

PolygonShape SpDroplet::shape() const {
  return {.area = units::rest_area, .perimeter = std::numbers::pi * units::droplet_diameter};
}

}  // namespace clog

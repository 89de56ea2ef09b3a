#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "clog/core/droplet/droplet_state.hpp"

namespace clog {

/// These functions do one step of the methods below for all coordinates. They are compiled for several
/// instruction sets.
namespace kernel {
struct ForceSums {
  double largest;                ///< largest absolute component of the force
  double power, speed2, force2;  ///< sums over all components: f v, v^2, f^2
};
ForceSums sum_forces(std::ptrdiff_t n, const double* force, const double* velocity);
/// v = kept v + gain f, limited to `fastest` in either direction; then x += time v.
struct PointMove {
  double kept, gain, fastest, time;
};
void move_points(std::ptrdiff_t n, const PointMove& move, const double* force, double* velocity,
                 double* position);
}  // namespace kernel

struct FireOptions {
  double mass = 1;             ///< mass of each point
  double largest_step = 1e-3;  ///< [t0]; must be stable for velocity Verlet
  double force_tolerance = 0;  ///< stop when no force component exceeds this [g rho sigma^2]
  int max_iterations = 0;
  double max_move = 0;  ///< no coordinate moves by more than this in one iteration [sigma]
};

struct FireResult {
  bool converged = false;
  int iterations = 0;
  double largest_force = 0;
};

/// Contact lists are updated once in this number of iterations, before the forces are computed.
inline constexpr int iterations_per_update = 3;

/// Bound on the displacement of points between an update of the contact lists and the last computation of
/// forces before the next update. max_move limits each coordinate, so a point may move farther by a factor of
/// sqrt(2).
inline Travel travel_between_updates(const FireOptions& options) {
  const double farthest = (iterations_per_update - 1) * options.max_move * std::numbers::sqrt2;
  return {.absolute = farthest, .relative = 2 * farthest};
}

/// Energy minimisation by the fast inertial relaxation engine, Bitzek et al., Phys. Rev. Lett. 97, 170201
/// (2006), with its standard constants. Velocities are left at zero.
/// @param forces  has update_contacts(state, travel) and evaluate(state, force)
template <class Forces>
FireResult minimize_fire(Forces& forces, DropletState& state, const FireOptions& options) {
  constexpr int min_downhill = 5;
  constexpr double grow = 1.1, shrink = 0.5, start_mixing = 0.1, less_mixing = 0.99;
  const Travel travel = travel_between_updates(options);
  Eigen::ArrayXd force(state.position.size());
  state.velocity.setZero();
  double dt = 0.25 * options.largest_step;
  double mixing = start_mixing;
  int downhill = 0;
  FireResult result;
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    if (result.iterations % iterations_per_update == 0) forces.update_contacts(state, travel);
    forces.evaluate(state, force);
    const kernel::ForceSums sums = kernel::sum_forces(force.size(), force.data(), state.velocity.data());
    const bool is_finite = std::isfinite(sums.force2);
    result.largest_force = is_finite ? sums.largest : std::numeric_limits<double>::infinity();
    result.converged = result.largest_force <= options.force_tolerance;
    if (result.converged || !is_finite) break;

    double kept = 0, gain = 0;
    if (sums.power > 0) {
      kept = 1 - mixing;
      gain = mixing * std::sqrt(sums.speed2 / sums.force2);
      if (++downhill > min_downhill) {
        dt = std::min(dt * grow, options.largest_step);
        mixing *= less_mixing;
      }
    } else {
      downhill = 0;
      dt *= shrink;
      mixing = start_mixing;
    }
    kernel::move_points(force.size(), {kept, gain + dt / options.mass, options.max_move / dt, dt},
                        force.data(), state.velocity.data(), state.position.data());
  }
  state.velocity.setZero();
  return result;
}

/// Relaxes the droplet by damped motion, as in a run. This is slower than FIRE, but it also works for some
/// forces that derive from no energy. With such forces FIRE may cycle for ever, because FIRE adapts to the
/// work that the forces do.
template <class Forces>
FireResult settle(Forces& forces, DropletState& state, const FireOptions& options, double damping_rate) {
  const double dt = options.largest_step;
  const double shrink = 1 / (1 + dt * damping_rate);
  const Travel travel = travel_between_updates(options);
  Eigen::ArrayXd force(state.position.size());
  state.velocity.setZero();
  FireResult result;
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    if (result.iterations % iterations_per_update == 0) forces.update_contacts(state, travel);
    forces.evaluate(state, force);
    const kernel::ForceSums sums = kernel::sum_forces(force.size(), force.data(), state.velocity.data());
    const bool is_finite = std::isfinite(sums.force2);
    result.largest_force = is_finite ? sums.largest : std::numeric_limits<double>::infinity();
    result.converged = result.largest_force <= options.force_tolerance;
    if (result.converged || !is_finite) break;
    kernel::move_points(force.size(), {shrink, shrink * dt / options.mass, options.max_move / dt, dt},
                        force.data(), state.velocity.data(), state.position.data());
  }
  state.velocity.setZero();
  return result;
}

}  // namespace clog

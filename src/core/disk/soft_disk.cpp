#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "clog/core/disk/sp_droplet.hpp"
#include "clog/core/droplet/droplet_model.hpp"
#include "clog/core/droplet/equilibrium.hpp"
#include "clog/core/droplet/fire.hpp"
#include "clog/core/droplet/release.hpp"
#include "clog/core/droplet/time_step.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/units.hpp"
#include "core/parameters/refusal.hpp"

namespace clog {
namespace {

/// Up to a dozen obstacles of a saturated array overlap a soft disk at once. For these contacts together, the
/// bound on (omega dt)^2 is the bound for all modes of the polygon together.
constexpr double most_contacts = 12;
constexpr double max_omega_dt2 = 3.0;

void leave_one_point(RunParameters&, double) {}

int one_point(const RunParameters&) { return 1; }
double no_width(const RunParameters&) { return 0; }

/// Frequency of a disk that oscillates on one obstacle [1/t0].
double frequency(const RunParameters& run) {
  return std::sqrt(contact_stiffness(*run.wall_stiffness, units::droplet_diameter) / units::droplet_mass);
}

/// The automatic step is at most a sixtieth of the period with which the disk oscillates on an obstacle.
void resolve_disk(RunParameters& run, double) {
  if (!run.wall_stiffness)
    throw Error(
        "missing wall-stiffness (E_w is the parameter of model=sp, there is no automatic value) "
        "give for example wall-stiffness=1");
  const double omega = frequency(run);
  if (!run.time_step)
    choose_time_step(run, rounded_down(std::min(drag_time_step(run), 0.1 / omega)),
                     {{"wall-stiffness", *run.wall_stiffness, 100 * omega * omega}});
  check_time_step(run);
  const double largest = std::sqrt(max_omega_dt2 / most_contacts) / omega;
  require(*run.time_step <= largest, "time-step", *run.time_step, [&] {
    return fmt::format("contact has omega*dt = {:.3g}) try {:.3g}", omega * *run.time_step, 0.99 * largest);
  });
}

Eigen::ArrayXd centre_alone(const RunParameters&) { return Eigen::ArrayXd::Zero(2); }
double reach(const RunParameters&) { return units::droplet_diameter / 2; }

ContactReach contact_reach_of_disk(const RunParameters& run) {
  return {.range = reach(run), .by_edges = false};
}

/// Relaxes a disk that starts in the void nearest to the box's centre.
DropletState release_disk(const RunParameters& run, const ObstacleArray& obstacles) {
  const Period& period = obstacles.period();
  DropletState state =
      state_at_rest(centre_alone(run), nearest_void(obstacles), {period.along(), period.across()});
  SpForces forces(run, obstacles);
  forces.set_weight(0);
  const double weight = units::droplet_mass * units::gravity;
  const FireOptions options{.mass = units::droplet_mass,
                            .largest_step = 0.2 / frequency(run),
                            .force_tolerance = release_force_tolerance * weight,
                            .max_iterations = 100000,
                            .max_move = 0.01};
  if (!minimize_fire(forces, state, options).converged)
    refuse_release("the soft disk does not come to rest", "a smaller wall-stiffness");
  return state;
}

/// Upper bound of the energy at release. It assumes that the disk overlaps the largest number of obstacles
/// that fit into its reach, and that each obstacle reaches at most to the disk's centre.
double energy_of_overlaps(const RunParameters& run) {
  const double spacing = run.obstacles.smallest_diameter() + run.obstacles.gap;
  const double across = (units::droplet_diameter + run.obstacles.diameter + spacing) / spacing;
  return std::isnan(across) ? 0 : across * across * run.wall_stiffness.value() / 2;
}

std::unique_ptr<Droplet> make_disk(const RunParameters& run, const ObstacleArray& obstacles,
                                   DropletState initial) {
  return std::make_unique<SpDroplet>(run, obstacles, std::move(initial));
}

Axes x_and_y(const DropletState& state) {
  Axes axes{.directions = Eigen::SparseMatrix<double>(2 * state.size(), 2 * state.size()),
            .num_tangential = 0,
            .slide = {}};
  axes.directions.setIdentity();
  return axes;
}  // NOLINT(clang-analyzer-unix.Malloc): the matrix owns this memory after the move

std::optional<DropletState> equilibrium_of_disk(const RunParameters& run, const ObstacleArray& obstacles,
                                                const DropletState& state) {
  SpForces forces(run, obstacles);
  return find_equilibrium(EquilibriumForces::of(forces, x_and_y, true), state);
}

Stability stability_of_disk(const RunParameters& run, const ObstacleArray& obstacles,
                            const DropletState& state) {
  SpForces forces(run, obstacles);
  return stability_of(EquilibriumForces::of(forces, x_and_y, true), state);
}

/// A disk cannot hang over an obstacle, so every clog is squeezed.
Hold hold_of_disk(const RunParameters&, const ObstacleArray&, const DropletState&) {
  return {.mechanism = ClogMechanism::squeezed, .geometry = {}};
}

/// A disk stays round, so it has no neck.
double neck_of_disk(const DropletState&, double) { return no_neck; }

}  // namespace

const DropletModel soft_disk = {.stiffness_key = "wall-stiffness",
                                .choose_points = leave_one_point,
                                .narrowest = no_width,
                                .resolve = resolve_disk,
                                .num_points = one_point,
                                .free_shape = centre_alone,
                                .reach = reach,
                                .contact_reach = contact_reach_of_disk,
                                .release = release_disk,
                                .most_energy_at_release = energy_of_overlaps,
                                .make = make_disk,
                                .equilibrium = equilibrium_of_disk,
                                .stability = stability_of_disk,
                                .hold = hold_of_disk,
                                .neck = neck_of_disk};

}  // namespace clog

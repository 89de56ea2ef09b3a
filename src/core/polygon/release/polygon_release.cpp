#include "core/polygon/release/polygon_release.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>

#include "clog/core/droplet/fire.hpp"
#include "clog/core/droplet/release.hpp"
#include "clog/core/droplet/shape.hpp"
#include "clog/core/polygon/forces/automatic_values.hpp"
#include "clog/core/polygon/forces/dp_forces.hpp"
#include "clog/core/polygon/forces/stability.hpp"
#include "clog/core/tools/units.hpp"
#include "core/polygon/release/rest_forces.hpp"

namespace clog {
namespace {

constexpr double radius = units::droplet_diameter / 2;

/// A polygon smaller than the droplet has a smaller perimeter, so its tension mode is stiffer and its area
/// mode softer.
FireOptions fire_options(const RunParameters& run, double perimeter) {
  const StiffModes modes = stiff_modes(run.dp, *run.wall_stiffness, perimeter, perimeter / *run.dp.vertices);
  return {.mass = units::droplet_mass / *run.dp.vertices,
          .largest_step = 0.5 * largest_stable_step(modes),
          .max_move = 0.05 * units::regular_edge_length(*run.dp.vertices)};
}

/// A small circle at rest in the nearest void, and the area of this circle.
struct Seed {
  DropletState state;
  double area;
};
Seed seed_polygon(const RunParameters& run, const ObstacleArray& obstacles) {
  const int n = *run.dp.vertices;
  const Eigen::Array2d place = nearest_void(obstacles);
  // The room is reduced by a hundredth, so that the circle touches nothing.
  const double room = 0.99 * (clearance(obstacles, place[0], place[1], 2 * radius) - *run.dp.contact_range);
  const double smallest_radius = 4 * run.dp.self_contact_range / (2 * std::numbers::pi);
  if (room < smallest_radius)
    refuse_release("no void near the centre of the box",
                   "a wider obstacle-gap or a smaller self-contact-range");
  const double area = units::rest_area * std::min(1.0, room * room / (radius * radius));
  const Period& period = obstacles.period();
  return {state_at_rest(regular_polygon(n, area), place, {period.along(), period.across()}), area};
}

/// The droplet grows with all kinds of contact and with evenly spread vertices, regardless of the interface
/// parameters of the run. If vertices were bunched, the interface would be too stiff for any step, and
/// obstacles would slip between the other vertices, which would be far apart. Springs along the interface
/// must be weak for the minimiser, because they have no energy. With a large tension, however, they must be
/// strong, because contact then bunches vertices at the corners of a squeezed droplet.
RunParameters with_growing_interface(RunParameters run) {
  run.dp.inertia = 1;  // the droplet starts at rest
  run.dp.perimeter_spring = PerimeterSpring::along;
  run.dp.perimeter_stiffness = 0.01 + 0.03 * run.dp.line_tension;
  run.dp.wall_contact = WallContact::edge;
  run.dp.self_contact = SelfContact::on;
  run.dp.receding_angle.reset();  // walls hold the droplet only after its release
  run.dp.advancing_angle.reset();
  run.dp.gravity = Gravity::vertex;  // without weight, the springs need no reaction on the area
  return run;
}

double vertex_weight(const RunParameters& run) {
  return units::droplet_mass * units::gravity / *run.dp.vertices;
}

DpForces weightless_forces(const RunParameters& run, const ObstacleArray& obstacles) {
  DpForces forces(run, obstacles);
  forces.set_weight(0);
  return forces;
}

/// Grows the droplet in stages to its full area.
/// @param area  the droplet's present area
void grow(const RunParameters& growing, double area, DpForces& forces, DropletState& state) {
  constexpr double growth = 1.02;  // factor by which the area grows in each stage
  RestForces rest_forces(growing, forces);
  while (area < units::rest_area) {
    area = std::min(units::rest_area, area * growth);
    forces.set_rest_area(area);
    FireOptions stage = fire_options(growing, polygon_shape(state.position).perimeter);
    stage.force_tolerance = vertex_weight(growing);
    stage.max_iterations = 400;
    minimize_fire(rest_forces, state, stage);
    if (state.recentre().any()) forces.forget_contacts();
  }
}

constexpr double damping_rate = 3;  // near the frequency of the softest modes [1/t0]

/// Relaxes the grown droplet. Returns whether it comes to rest.
bool comes_to_rest(RunParameters& growing, const ObstacleArray& obstacles, DpForces& forces,
                   const FireOptions& options, const FireOptions& longer, DropletState& state) {
  RestForces rest_forces(growing, forces);
  bool rests = minimize_fire(rest_forces, state, options).converged ||
               settle(rest_forces, state, longer, damping_rate).converged;
  // Springs along the interface have no energy, so vertices may slide in a small cycle for ever. Weaker
  // springs make this motion slower.
  constexpr double weaker = 0.3;
  constexpr int most_weakenings = 4;
  for (int i = 0; i < most_weakenings && !rests; ++i) {
    *growing.dp.perimeter_stiffness *= weaker;
    DpForces weaker_forces = weightless_forces(growing, obstacles);
    RestForces weaker_rest_forces(growing, weaker_forces);
    rests = settle(weaker_rest_forces, state, longer, damping_rate).converged;
  }
  return rests;
}

}  // namespace

DropletState release_polygon(const RunParameters& run, const ObstacleArray& obstacles) {
  auto [state, area] = seed_polygon(run, obstacles);
  RunParameters growing = with_growing_interface(run);
  DpForces forces = weightless_forces(growing, obstacles);
  grow(growing, area, forces, state);

  FireOptions options = fire_options(growing, polygon_shape(state.position).perimeter);
  options.force_tolerance = release_force_tolerance * vertex_weight(run);
  options.max_iterations = 100000;
  FireOptions longer = options;
  longer.max_iterations = 500000;
  bool rests = comes_to_rest(growing, obstacles, forces, options, longer, state);
  // Then the droplet relaxes with its own interface. Springs that carry tension act only after the release.
  RunParameters own = run;
  own.dp.inertia = growing.dp.inertia;
  own.dp.receding_angle = growing.dp.receding_angle;
  own.dp.advancing_angle = growing.dp.advancing_angle;
  if (own.dp.perimeter_spring != PerimeterSpring::along) {
    own.dp.perimeter_spring = growing.dp.perimeter_spring;
    own.dp.perimeter_stiffness = growing.dp.perimeter_stiffness;
  }
  DpForces own_forces = weightless_forces(own, obstacles);
  RestForces own_rest_forces(own, own_forces);
  if (rests) {
    const DropletState relaxed = state;
    if (!minimize_fire(own_rest_forces, state, options).converged) {
      state = relaxed;
      rests = settle(own_rest_forces, state, longer, damping_rate).largest_force <=
              release_sliding_tolerance * vertex_weight(run);
    }
  }
  if (!rests)
    refuse_release(
        "the grown droplet does not come to rest",
        run.dp.line_tension > nearly_rigid_tension
            ? fmt::format(
                  "line-tension={}, since stiffer droplets are nearly rigid, fewer obstacles, the soft "
                  "disk (model=sp)",
                  nearly_rigid_tension)
            : std::string("a larger line-tension"));
  if (num_enclosed(state, obstacles) > 0)
    refuse_release("the grown droplet encloses an obstacle", "more vertices");
  return state;
}

}  // namespace clog

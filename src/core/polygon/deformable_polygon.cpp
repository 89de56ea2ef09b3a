#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "clog/core/droplet/droplet_model.hpp"
#include "clog/core/droplet/equilibrium.hpp"
#include "clog/core/droplet/shape.hpp"
#include "clog/core/polygon/clog_geometry.hpp"
#include "clog/core/polygon/forces/automatic_values.hpp"
#include "clog/core/polygon/forces/dp_forces.hpp"
#include "clog/core/polygon/neck.hpp"
#include "clog/core/polygon/step/dp_droplet.hpp"
#include "clog/core/tools/units.hpp"
#include "core/polygon/release/polygon_release.hpp"
#include "core/polygon/release/rest_forces.hpp"

namespace clog {
namespace {

void choose_vertices(RunParameters& run, double obstacle_diameter) {
  if (!run.dp.vertices) run.dp.vertices = automatic_vertices(run, obstacle_diameter);
}

int num_vertices(const RunParameters& run) { return *run.dp.vertices; }

/// Length of an edge at rest [sigma]. The polygon does not resolve narrower passages.
double edge_length(const RunParameters& run) { return units::regular_edge_length(*run.dp.vertices); }

/// The regular polygon in which pressure balances line tension and springs; its area is a little smaller than
/// a_0.
Eigen::ArrayXd free_polygon(const RunParameters& run) {
  const int n = *run.dp.vertices;
  const double spring =
      run.dp.perimeter_spring == PerimeterSpring::rest ? run.dp.perimeter_stiffness.value() * n : 0;
  const double rest_edge = units::regular_edge_length(n);
  // The area a solves K_a (a_0 - a) = T dP/da, where T is the tension of an edge and dP/da = P/(2a). The
  // difference a_0 - a is small, so the iteration converges at once. If the area is too soft for the tension,
  // there is no solution, and the result is half of a_0.
  double area = units::rest_area;
  for (int i = 0; i < 50; ++i) {
    const double edge = units::regular_edge_length(n, area);
    const double tension = run.dp.line_tension + spring * (edge - rest_edge);
    area = std::max(units::rest_area / 2,
                    units::rest_area - tension * n * edge / (2 * area) / *run.dp.area_stiffness);
  }
  return regular_polygon(n, area);
}

double reach_of_polygon(const RunParameters& run) {
  return free_polygon(run).head(*run.dp.vertices).maxCoeff() + run.dp.contact_range.value();
}

ContactReach contact_reach_of_polygon(const RunParameters& run) {
  return {.range = run.dp.contact_range.value(), .by_edges = run.dp.wall_contact == WallContact::edge};
}

/// Upper bound of the energy of a released interface. The bound is far too large in practice, because among
/// obstacles the interface is hardly twice as long as a circle.
double energy_of_interface(const RunParameters& run) {
  constexpr double excess_perimeter = 20;  // [sigma]
  const double spring =
      run.dp.perimeter_spring == PerimeterSpring::along ? 0 : run.dp.perimeter_stiffness.value_or(0);
  return excess_perimeter * (run.dp.line_tension + spring * excess_perimeter / 2);
}

std::unique_ptr<Droplet> make_polygon(const RunParameters& run, const ObstacleArray& obstacles,
                                      DropletState initial) {
  return std::make_unique<DpDroplet>(run, obstacles, std::move(initial));
}

/// Axes at each vertex: normal to the chord between its neighbours, then along it.
Axes axes_of_interface(const DpParameters& dp, const DropletState& state) {
  using Eigen::Index;
  const Index n = state.size();
  Axes axes{.directions = Eigen::SparseMatrix<double>(2 * n, 2 * n),
            .num_tangential = n,
            .slide = Eigen::VectorXd(n)};
  axes.directions.reserve(Eigen::VectorXi::Constant(2 * n, 2));
  for (Index i = 0; i < n; ++i) {
    const Index next = (i + 1) % n;
    const Index previous = (i + n - 1) % n;
    const double chord_x = state.x()[next] - state.x()[previous];
    const double chord_y = state.y()[next] - state.y()[previous];
    const double length = std::hypot(chord_x, chord_y);
    axes.directions.insert(i, i) = chord_y / length;
    axes.directions.insert(n + i, i) = -chord_x / length;
    axes.directions.insert(i, n + i) = chord_x / length;
    axes.directions.insert(n + i, n + i) = chord_y / length;
    axes.slide[i] = length;
  }
  axes.slide.normalize();
  // Springs that carry tension leave uneven edges, which make the ripples of the energy along the slide
  // higher. So in this case the search treats the slide like any other motion.
  if (dp.perimeter_spring != PerimeterSpring::along) axes.slide.resize(0);
  return axes;
}  // NOLINT(clang-analyzer-unix.Malloc): the matrix owns this memory after the move

/// @param forces  must outlive the result, and so must the run
EquilibriumForces forces_along_interface(const RunParameters& run, RestForces& forces) {
  const auto axes = [&run](const DropletState& at) { return axes_of_interface(run.dp, at); };
  return EquilibriumForces::of(forces, axes, run.dp.perimeter_spring != PerimeterSpring::along);
}

std::optional<DropletState> equilibrium_of_polygon(const RunParameters& run, const ObstacleArray& obstacles,
                                                   const DropletState& state) {
  if (!state.crossings.empty()) return std::nullopt;
  DpForces forces(run, obstacles);
  RestForces rest_forces(run, forces);
  const EquilibriumForces asked = forces_along_interface(run, rest_forces);
  std::optional<DropletState> rest = find_equilibrium(asked, state);
  if (!forces.has_anchors()) return rest;
  // Springs tie the droplet to walls. Their anchors stay fixed during a search. A wall that has yielded
  // exerts its largest force, wherever the droplet moves. The search is repeated, at most most_yields times,
  // until every wall can exert the force that holds the droplet.
  constexpr int most_yields = 20;
  // If all walls can hold, the excess after this many yields is below the first excess
  // (docs/notes/2026-11-25-searches-with-friction.md). If not, the excess stays far above the first excess,
  // even after most_yields.
  constexpr int yields_until_excess_has_fallen = 12;
  const double bearable = 1e-6 * units::droplet_mass * units::gravity / *run.dp.vertices;
  WallTouches touches(run, obstacles);
  double first_excess = 0;
  for (int yields = 0; rest && yields < most_yields; ++yields) {
    forces.update_contacts(*rest, {});
    const WallYield yield =
        forces.let_walls_yield(*rest, touches, forces.walls().items(), Purpose::equilibrium);
    if (yield.excess <= bearable) {
      for (WallAnchor& anchor : rest->anchors) anchor.yields = 0;
      return rest;
    }
    if (yields == 0) first_excess = yield.excess;
    if (yields >= yields_until_excess_has_fallen && yield.excess > first_excess) return std::nullopt;
    rest = find_equilibrium(asked, *rest);
    if (rest && (rest->position - state.position).abs().maxCoeff() > farthest_rest) return std::nullopt;
  }
  return std::nullopt;
}

/// The stability is unknown for an interface that crosses itself or may cross itself.
Stability stability_of_polygon(const RunParameters& run, const ObstacleArray& obstacles,
                               const DropletState& state) {
  if (run.dp.self_contact == SelfContact::off || !state.crossings.empty()) return Stability::unknown;
  DpForces forces(run, obstacles);
  RestForces rest_forces(run, forces);
  return stability_of(forces_along_interface(run, rest_forces), state);
}

/// @param circles  the circles that carry the droplet
double friction_use(const RunParameters& run, const ObstacleArray& obstacles, const DropletState& state,
                    std::span<const Obstacle> circles) {
  DpForces forces(run, obstacles);
  if (!forces.friction().is_on()) return std::numeric_limits<double>::quiet_NaN();
  forces.update_contacts(state, {});
  WallTouches touches(run, obstacles);
  return forces.friction().use(state, touches.find(state, forces.walls().items()), circles);
}

Hold hold_of_polygon(const RunParameters& run, const ObstacleArray& obstacles, const DropletState& state) {
  const ClogGeometry geometry = clog_geometry(state, obstacles, run.dp);
  return {.mechanism = geometry.mechanism(),
          .geometry = geometry,
          .friction_use = friction_use(run, obstacles, state, geometry.carriers)};
}

double neck_of_polygon(const DropletState& state, double below) {
  return thinnest_neck(state.position, below).width;
}

}  // namespace

const DropletModel deformable_polygon = {.stiffness_key = "line-tension",
                                         .choose_points = choose_vertices,
                                         .narrowest = edge_length,
                                         .resolve = resolve_polygon,
                                         .num_points = num_vertices,
                                         .free_shape = free_polygon,
                                         .reach = reach_of_polygon,
                                         .contact_reach = contact_reach_of_polygon,
                                         .release = release_polygon,
                                         .most_energy_at_release = energy_of_interface,
                                         .make = make_polygon,
                                         .equilibrium = equilibrium_of_polygon,
                                         .stability = stability_of_polygon,
                                         .hold = hold_of_polygon,
                                         .neck = neck_of_polygon};

}  // namespace clog

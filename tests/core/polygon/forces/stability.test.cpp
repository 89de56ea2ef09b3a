#include "clog/core/polygon/forces/stability.hpp"
#include "clog/core/run/resolve.hpp"

#include <gtest/gtest.h>

#include "polygon/forces/reference_forces.hpp"
#include "support.hpp"

namespace clog {
namespace {

using namespace test;

/// The largest omega^2 of small motions about a shape: the largest eigenvalue of the Hessian, divided by the
/// mass. It comes from power iteration, in which finite differences replace products with the Hessian.
double stiffest_omega2(const RunParameters& run, const Eigen::ArrayXd& position,
                       const ObstacleArray& obstacles = no_obstacles()) {
  const int n = *run.dp.vertices;
  ReferenceForces forces(run, obstacles);
  forces.set_rest_area(polygon_shape(position).area);
  DropletState state = state_of(position);
  forces.update_contacts(state, {});
  Eigen::ArrayXd direction = shaken(Eigen::ArrayXd::Zero(position.size()), 1.0, 5);
  Eigen::ArrayXd above(2 * n), below(2 * n);
  constexpr double h = 1e-7;
  double stiffness = 0;
  for (int iteration = 0; iteration < 400; ++iteration) {
    direction /= direction.matrix().norm();
    state.position = position + h * direction;
    forces.evaluate(state, above);
    state.position = position - h * direction;
    forces.evaluate(state, below);
    direction = (below - above) / (2 * h);
    stiffness = direction.matrix().norm();
  }
  return stiffness / (units::droplet_mass / n);
}

TEST(StiffModes, BoundTheStiffestModeOfTheDroplet) {
  // The shapes are a circle, and two lobes with a waist. The vertices are evenly spread, as springs would
  // keep them.
  for (const Eigen::ArrayXd& position : {regular_polygon(128, units::rest_area), dumbbell(128, 0.2)})
    for (const double line_tension : {0.05, 1.0, 10.0}) {
      RunParameters run = bare_parameters(128);
      run.dp.line_tension = line_tension;
      StiffModes modes = stiff_modes(run.dp, *run.wall_stiffness, polygon_shape(position).perimeter,
                                     polygon_shape(position).perimeter / *run.dp.vertices);
      modes.contact = 0;  // there are no walls here
      const double stiffest = stiffest_omega2(run, position);
      EXPECT_LE(stiffest, 1.001 * modes.sum()) << "Gamma " << line_tension;
      EXPECT_GE(stiffest, 0.3 * modes.sum())
          << "a bound far above the truth would waste steps, Gamma " << line_tension;
    }
}

TEST(StiffModes, BoundTwoFilmsThatTouch) {
  const double diameter = units::regular_edge_length(128);
  RunParameters run = bare_parameters(128);
  run.dp.line_tension = 0.1;
  const Eigen::ArrayXd position = dumbbell(128, 0.9 * diameter);
  const StiffModes modes = stiff_modes(run.dp, *run.wall_stiffness, polygon_shape(position).perimeter,
                                       polygon_shape(position).perimeter / 128);
  const double stiffest = stiffest_omega2(run, position);
  EXPECT_LE(stiffest, 1.001 * (modes.sum() - modes.contact + modes.self_contact));
  EXPECT_GT(stiffest, 0.5 * modes.self_contact) << "the film touches itself";
}

/// A droplet that hangs over a circle around the origin. The droplet is a horseshoe of thickness 0.4. The
/// vertices are evenly spread. The vertices on the inner side are at the distance `inner` from the origin.
Eigen::ArrayXd horseshoe_outline(int num_vertices, double inner) {
  constexpr double open = 2, thick = 0.4;  // half the opening angle [rad]; thickness [sigma]
  const double outer = inner + thick;
  const double lengths[] = {2 * open * outer, thick, 2 * open * inner, thick};
  const double whole = lengths[0] + lengths[1] + lengths[2] + lengths[3];
  const auto polar = [](double r, double angle) {
    return Eigen::Array2d(r * std::cos(angle), r * std::sin(angle));
  };
  const auto point = [&](double s) {
    if (s < lengths[0]) return polar(outer, -open + s / outer);
    s -= lengths[0];
    if (s < thick) return polar(outer - s, open);
    s -= thick;
    if (s < lengths[2]) return polar(inner, open - s / inner);
    return polar(inner + s - lengths[2], -open);
  };
  Eigen::ArrayXd position(2 * num_vertices);
  for (int i = 0; i < num_vertices; ++i) {
    const Eigen::Array2d p = point(whole * i / num_vertices);
    position[i] = p[0];
    position[num_vertices + i] = p[1];
  }
  return position;
}

TEST(StiffModes, LeaveRoomForAContactThatTurnsWithItsEdges) {
  // On a round obstacle, a half edge presses deeper into the obstacle when it turns. This effect grows with
  // the overlap, and makes the stiffest mode stiffer than the bound for a flat contact. The bounds leave a
  // margin below 4, the limit of stability. The effect must be smaller than this margin, even at the largest
  // overlap that the automatic step allows.
  const double radius = 0.15;
  for (const int n : {64, 128, 256, 512}) {
    RunParameters run = bare_parameters(n);
    run.dp.line_tension = 0.01;
    run.dp.area_stiffness = 10;
    run.dp.perimeter_stiffness = 1e-4;
    run.dp.contact_range = 0;
    const Eigen::ArrayXd position = horseshoe_outline(n, radius - 0.02 * units::regular_edge_length(n));
    const double per_vertex = auto_contact_omega_dt2 / 2;  // k_c dt^2/(M/N_v) of the automatic contact
    const double vertex_mass = units::droplet_mass / n;
    const double step2 = per_vertex * vertex_mass / 1000;
    const double stiffest = stiffest_omega2(run, position, ObstacleArray(20, {{0, 0, radius}})) * step2;
    EXPECT_LE(stiffest, auto_contact_omega_dt2 + (4 - max_total_omega_dt2)) << n;
    EXPECT_GT(stiffest, auto_contact_omega_dt2) << n;
  }
}

TEST(StiffModes, ContactModeIsThatOfAVertexWithBothItsEdges) {
  const RunParameters run = bare_parameters(128);
  const StiffModes modes = stiff_modes(run.dp, *run.wall_stiffness, 3.14, 3.14 / *run.dp.vertices);
  EXPECT_NEAR(modes.contact, 2 * 1000 * 128 / units::droplet_mass, 1e-6);
}

TEST(StableSteps, AreAsManyAsTheModesNeed) {
  const RunParameters run = resolve(RunParameters{});
  const StiffModes modes = stiff_modes(run.dp, *run.wall_stiffness, 3.14, 3.14 / *run.dp.vertices);
  const double largest = largest_stable_step(modes);
  const auto num = [&](int steps, double step) {
    return stable_steps(modes, steps, step, Pressure::present).num;
  };
  EXPECT_EQ(num(1, largest), 1);
  EXPECT_EQ(num(1, 1.01 * largest), 2);
  EXPECT_EQ(num(1, 5.5 * largest), 6);
  // This number of sub-steps is the smallest that is stable.
  EXPECT_EQ(num(8, largest), 8);
  EXPECT_EQ(num(8, 1.01 * largest), 9);
  EXPECT_EQ(num(8, 1.99 * largest), 16);
  EXPECT_EQ(num(8, 2.01 * largest), 24) << "beyond twice as many, a multiple";
  EXPECT_EQ(num(8, 0.5 * largest), 8) << "no step is longer than the time step";
  EXPECT_EQ(num(8, 1e9 * largest), 8 * most_substeps);
  EXPECT_EQ(stable_steps(modes, 8, largest, Pressure::present).length, largest);
  EXPECT_NEAR(stable_steps(modes, 8, 1.5 * largest, Pressure::present).length, largest, 1e-12 * largest);
}

TEST(StableSteps, HaveAnImplicitPressureWhereTheAreaModeIsTheStiffOne) {
  const RunParameters run = resolve(RunParameters{});
  const double step = *run.time_step;
  const auto steps = [&](double perimeter, double shortest_edge, Pressure most) {
    return stable_steps(stiff_modes(run.dp, *run.wall_stiffness, perimeter, shortest_edge), 8, step, most);
  };
  const double edge = units::regular_edge_length(*run.dp.vertices);
  EXPECT_EQ(steps(3.14, edge, Pressure::implicit).pressure, Pressure::present) << "a circle needs none";
  EXPECT_EQ(steps(3.14, edge, Pressure::implicit).num, 8);
  const Steps drawn_out = steps(10 * 3.14, 10 * edge, Pressure::implicit);
  EXPECT_EQ(drawn_out.pressure, Pressure::implicit);
  EXPECT_EQ(drawn_out.num, 8);
  const Steps split = steps(10 * 3.14, 10 * edge, Pressure::present);
  EXPECT_EQ(split.pressure, Pressure::present);
  EXPECT_GT(split.num, 24);
  EXPECT_EQ(steps(3.14, 0.02 * edge, Pressure::implicit).pressure, Pressure::present)
      << "it does not help a short edge";
}

}  // namespace
}  // namespace clog

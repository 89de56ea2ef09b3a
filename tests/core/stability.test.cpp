#include "clog/core/stability.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace clog {
namespace {

using namespace test;

/// Largest omega^2 of small motions about a shape: power iteration on the finite-difference Hessian over the
/// mass.
double stiffest_omega2(const RunParameters& run, const Eigen::ArrayXd& position) {
  const int n = run.dp.vertices;
  const ObstacleArray nothing = no_obstacles();
  DpForces forces(run, nothing);
  DropletState state = state_of(position);
  forces.update_contacts(state, {});
  Eigen::ArrayXd direction = shaken(Eigen::ArrayXd::Zero(2 * n), 1.0, 5);
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
  for (const double line_tension : {0.05, 1.0, 10.0})
    for (const double stretch : {1.0, 3.0}) {
      RunParameters run = bare_parameters(128);
      run.dp.line_tension = line_tension;
      Eigen::ArrayXd position = regular_polygon(128, units::rest_area);
      position.head(128) *= stretch;
      position.tail(128) /= stretch;
      StiffModes modes = stiff_modes(run.dp, *run.wall_stiffness, polygon_shape(position).perimeter);
      modes.contact = 0;  // nothing to touch here
      const double stiffest = stiffest_omega2(run, position);
      // Edges of a stretched regular polygon differ in length, and the shortest are the stiffest; the springs
      // keep them within a few percent of each other in a run.
      if (stretch == 1.0) {
        EXPECT_LE(stiffest, 1.001 * modes.sum()) << "Gamma " << line_tension;
      }
      EXPECT_GE(stiffest, 0.3 * modes.area) << "Gamma " << line_tension << ", stretch " << stretch;
    }
}

TEST(StiffModes, ContactModeIsThatOfAVertexWithBothItsEdges) {
  const RunParameters run = bare_parameters(128);
  const StiffModes modes = stiff_modes(run.dp, *run.wall_stiffness, 3.14);
  EXPECT_NEAR(modes.contact, 2 * 1000 * 128 / units::droplet_mass, 1e-6);
}

TEST(NumSubsteps, IsOneUpToTheLargestStableStep) {
  const RunParameters run = resolve(RunParameters{});
  const StiffModes modes = stiff_modes(run.dp, *run.wall_stiffness, 3.14);
  const double largest = largest_stable_step(modes);
  EXPECT_EQ(num_substeps(modes, largest), 1);
  EXPECT_EQ(num_substeps(modes, 1.01 * largest), 2);
  EXPECT_EQ(num_substeps(modes, 5.5 * largest), 6);
}

}  // namespace
}  // namespace clog

/// Tests which part of a droplet's weight the corners of a polygon can hold if the two lobes of the droplet
/// hang over one obstacle.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "clog/core/polygon/clog_geometry.hpp"
#include "clog/core/polygon/step/dp_droplet.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "support.hpp"

namespace clog {
namespace {

constexpr double obstacle_radius = 0.15;
constexpr double box = 60;
constexpr double middle = box / 2;

RunParameters robust_hanging(double line_tension, int vertices) {
  RunParameters run;
  run.dp.line_tension = line_tension;
  run.dp.vertices = vertices;
  run.obstacles.box = box;
  return resolve(run);
}

RunParameters elastic(double line_tension, int vertices) {
  RunParameters run;
  run.dp.line_tension = line_tension;
  run.dp.vertices = vertices;
  run.dp.perimeter_spring = PerimeterSpring::rest;
  run.dp.perimeter_stiffness_ratio = 0.1;
  run.dp.gravity = Gravity::vertex;
  run.obstacles.box = box;
  return resolve(run);
}

ObstacleArray one_obstacle() { return {box, {{middle, middle, obstacle_radius}}}; }

/// A circle straight upstream of the obstacle. A vertex (phase 0) or the middle of an edge (phase 1/2) faces
/// the obstacle.
DropletState above_the_obstacle(const RunParameters& run, double phase, double aside = 0) {
  const int n = *run.dp.vertices;
  const Eigen::ArrayXd circle = regular_polygon(n, units::rest_area);
  const double turn = 2 * std::numbers::pi * phase / n;
  Eigen::ArrayXd position(2 * n);
  position << std::cos(turn) * circle.head(n) - std::sin(turn) * circle.tail(n) - 0.66,
      std::sin(turn) * circle.head(n) + std::cos(turn) * circle.tail(n) + aside;
  DropletState state = test::state_of(position, box);
  state.frame.origin = {middle, middle};
  return state;
}

/// Replaces a state by the mean of this state and its mirror image. In the mirror image vertices `i` and
/// `first - i` are exchanged.
void make_symmetric(DropletState& state, int first) {
  const auto n = static_cast<int>(state.size());
  const Eigen::ArrayXd before = state.position;
  for (int i = 0; i < n; ++i) {
    const int opposite = (first - i + n) % n;
    state.position[i] = (before[i] + before[opposite]) / 2;
    state.position[n + i] = (before[n + i] - before[n + opposite]) / 2;
  }
}

/// A droplet at rest with two lobes that are forced to be equal. Without this constraint the droplet would
/// slide off.
struct Hanging {
  double energy = 0;
  ClogGeometry geometry;
  double longest_edge = 0;  ///< near the obstacle
};

Hanging hang(const RunParameters& run, bool on_an_edge) {
  const int n = *run.dp.vertices;
  const ObstacleArray obstacle = one_obstacle();
  DropletState state = above_the_obstacle(run, on_an_edge ? 0.5 : 0);
  Hanging hanging;
  double kinetic = 1;
  for (int round = 0; round < 400 && kinetic > 1e-13; ++round) {
    DpDroplet droplet(run, obstacle, state);
    droplet.advance(640);
    kinetic = droplet.kinetic_energy();
    hanging.energy = droplet.potential_energy().total();
    state = droplet.state();
    hanging.energy -= units::droplet_mass * units::gravity * state.frame.origin[0];
    make_symmetric(state, on_an_edge ? n - 1 : 0);
    if (round > 40) state.velocity.setZero();
  }
  EXPECT_LE(kinetic, 1e-13);
  hanging.geometry = clog_geometry(state, obstacle, run.dp);
  const Eigen::Array2d origin = state.frame.origin - middle;
  for (int i = 0; i < n; ++i) {
    const int next = (i + 1) % n;
    const Eigen::Array2d begin{state.position[i], state.position[n + i]};
    const Eigen::Array2d end{state.position[next], state.position[n + next]};
    if (((begin + end) / 2 + origin).matrix().norm() < obstacle_radius + 0.02)
      hanging.longest_edge = std::max(hanging.longest_edge, (end - begin).matrix().norm());
  }
  return hanging;
}

/// As the droplet slides over the obstacle, its energy has a ripple with a period of one edge. The extremes
/// of the ripple are the two symmetric states. @return the largest force of the ripple divided by the weight
double held_by_ripple(const Hanging& vertex, const Hanging& edge) {
  return std::numbers::pi * std::abs(vertex.energy - edge.energy) / vertex.longest_edge /
         (units::droplet_mass * units::gravity);
}

struct Case {
  const char* name;
  RunParameters (*parameters)(double line_tension, int vertices);
  double line_tension;
};

class MeshHold : public testing::TestWithParam<Case> {};

TEST_P(MeshHold, IsBoundedByItsColumnAndFallsAsTheSquareOfTheEdge) {
  double bound_before = 0;
  for (const int vertices : {128, 256, 512}) {
    const RunParameters run = GetParam().parameters(GetParam().line_tension, vertices);
    const Hanging vertex = hang(run, false), edge = hang(run, true);
    ASSERT_EQ(vertex.geometry.mechanism(), ClogMechanism::wrapped);
    const double held = held_by_ripple(vertex, edge);
    const double bound = vertex.geometry.mesh_hold;
    RecordProperty("held_" + std::to_string(vertices), std::to_string(held));
    EXPECT_LT(held, bound) << vertices;
    const double x = vertex.longest_edge / obstacle_radius;
    EXPECT_NEAR(bound, x * x / 16, 0.2 * bound) << vertices;
    if (vertices > 128) {
      EXPECT_NEAR(bound / bound_before, 0.25, 0.03) << vertices;
    }
    bound_before = bound;
  }
  EXPECT_LT(bound_before, 0.01) << "of 512 vertices";
}

/// Nothing except the mesh can hold two lobes over one obstacle, so every droplet must slide off.
TEST_P(MeshHold, LetsADropletSlideOffAsItHasTo) {
  const RunParameters run = GetParam().parameters(GetParam().line_tension, 256);
  const auto obstacle = std::make_shared<const ObstacleArray>(one_obstacle());
  for (const double phase : {0.0, 0.25, 0.5, 0.75})
    for (const double aside : {0.0001, 0.001}) {
      DropletRun fall(run, obstacle, above_the_obstacle(run, phase, aside), 6.0);
      while (!fall.advance(1024)) continue;
      EXPECT_EQ(fall.result().status, RunStatus::passed) << "phase " << phase << ", aside " << aside;
    }
}

INSTANTIATE_TEST_SUITE_P(OfPresets, MeshHold,
                         testing::Values(Case{"robust", robust_hanging, 0.24}, Case{"elastic", elastic, 0.1}),
                         [](const auto& test) { return std::string(test.param.name); });

/// A mesh can hold more weight on a tighter bend or with longer edges, so smaller obstacles need more
/// vertices.
TEST(MeshHoldOfAPlan, FollowsFromTheSmallestObstacle) {
  RunParameters run;
  run.dp.line_tension = 0.05;
  const int usual = *resolve(run).dp.vertices;
  run.obstacles.diameter = 0.15;
  EXPECT_NEAR(*resolve(run).dp.vertices, 2 * usual, 16);
  run.obstacles.diameter = 0.01;
  EXPECT_EQ(*resolve(run).dp.vertices, 1024) << "at most";
  run.obstacles.diameter = 0.3;
  run.dp.line_tension = 1;
  EXPECT_EQ(*resolve(run).dp.vertices, 128) << "does not hang";
  run.dp.line_tension = 0.05;
  run.dp.vertices = 64;
  EXPECT_EQ(*resolve(run).dp.vertices, 64) << "as given";
  run.obstacles = {};
  run.obstacles.layout = ObstacleLayout::channel;
  run.dp.vertices.reset();
  EXPECT_EQ(*resolve(run).dp.vertices, 128) << "there is nothing to hang over";
}

}  // namespace
}  // namespace clog

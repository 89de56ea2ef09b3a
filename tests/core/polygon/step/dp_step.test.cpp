#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "clog/core/polygon/forces/dp_forces.hpp"
#include "clog/core/polygon/step/dp_droplet.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/instruction_set.hpp"
#include "core/polygon/release/rest_forces.hpp"
#include "readable_droplet.hpp"
#include "support.hpp"

namespace clog {
namespace {

using namespace test;

/// The distance of the nearest vertex from a wedge.
double distance_from(const Wedge& wedge, const DropletState& state) {
  double nearest = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < state.size(); ++i)
    nearest = std::min(
        nearest, distance_to(wedge, Eigen::Array2d(state.x()[i], state.y()[i]) - wedge.centre()).distance);
  return nearest;
}

/// Expects the same anchors, in any order.
void expect_same_anchors(const DropletState& state, const DropletState& expected) {
  ASSERT_EQ(state.anchors.size(), expected.anchors.size());
  for (const WallAnchor& one : expected.anchors) {
    const auto found = std::ranges::find_if(state.anchors, [&](const WallAnchor& anchor) {
      return anchor.holder == one.holder && anchor.wall.is(one.wall);
    });
    ASSERT_NE(found, state.anchors.end()) << one.holder;
    EXPECT_NEAR(found->x, one.x, 1e-13);
    EXPECT_NEAR(found->y, one.y, 1e-13);
    EXPECT_NEAR(found->slip, one.slip, 1e-13);
  }
}

void make_elastic(RunParameters& run) {
  run.dp.perimeter_spring = PerimeterSpring::rest;
  run.dp.gravity = Gravity::vertex;
}

struct StepCase {
  std::string name;
  void (*change)(RunParameters&);
};

class Step : public testing::TestWithParam<StepCase> {
 protected:
  void TearDown() override { use_instruction_set("auto"); }

  static RunParameters parameters(int vertices) {
    RunParameters run;
    run.dp.vertices = vertices;
    run.dp.line_tension = 0.3;
    run.time_step = 1e-3;
    // The thickness of the films in these tests suits the published ranges of contacts.
    run.dp.contact_range = units::regular_edge_length(vertices) / 2;
    run.dp.self_contact_range = units::regular_edge_length(vertices);
    GetParam().change(run);
    return resolve(run);
  }
  /// The dumbbell, scaled to about the area of a droplet.
  static Eigen::ArrayXd full_size_dumbbell(int vertices, double film) {
    const double thin = units::regular_edge_length(vertices);
    const double size = std::sqrt(units::rest_area / polygon_shape(dumbbell(vertices, thin)).area);
    return size * dumbbell(vertices, film / size);
  }
  /// A droplet that moves, touches itself, and touches a circle.
  struct Scene {
    RunParameters run;
    DropletState initial;
    ObstacleArray walls;
  };
  static Scene touching_droplet(int vertices) {
    const double diameter = units::regular_edge_length(vertices);
    DropletState initial = state_of(shaken(full_size_dumbbell(vertices, 0.98 * diameter), 0.002 * diameter));
    initial.velocity = shaken(Eigen::ArrayXd::Zero(initial.position.size()), 0.03, 7);
    const double end = initial.x().maxCoeff();
    return {parameters(vertices), std::move(initial), {20, {{end + 0.15 + 0.45 * diameter, 0.02, 0.15}}}};
  }
};

TEST_P(Step, IsThatOfTheReadableFormWithEveryInstructionSet) {
  // A droplet with unevenly spread vertices and a neck that is thin enough to touch itself. One obstacle and
  // one wedge are at the neck. The other obstacle is at one end of the droplet, and the other wedge at the
  // other end.
  for (const int vertices : {64, 101, 256}) {
    const RunParameters run = parameters(vertices);
    const double diameter = units::regular_edge_length(vertices);
    const double film = 0.98 * diameter;
    DropletState initial = state_of(shaken(full_size_dumbbell(vertices, film), 0.002 * film));
    initial.velocity = shaken(Eigen::ArrayXd::Zero(initial.position.size()), 0.03, 7);
    const double end = initial.x().maxCoeff();
    // One wedge touches a vertex with its flank, and the other with its tip.
    const double touching = 0.45 * diameter;
    Eigen::Index left, below;
    initial.x().minCoeff(&left);
    (initial.x().abs() + (initial.y() > 0).cast<double>()).minCoeff(&below);
    const std::vector<Wedge> wedges = {
        {.tip = {initial.x()[left] - touching, 0.03}, .axis = {-0.6, 0.8}, .half_angle = 1.2, .radius = 0.02},
        {.tip = {initial.x()[below], initial.y()[below] - touching},
         .axis = {0, -1},
         .half_angle = 0.5,
         .radius = 0.03}};
    const ObstacleArray walls(
        20, {{end + 0.15 + touching, 0.02, 0.15}, {0.01, film / 2 + 0.1 + touching, 0.1}}, wedges);
    for (const Wedge& wedge : wedges) ASSERT_LT(distance_from(wedge, initial), diameter / 2);
    const auto readable_form = [&] {
      ReadableDroplet droplet(run, walls, initial);
      for (int step = 0; step < 3; ++step) droplet.step();
      return droplet.state();
    };
    const auto position_error = [](const DropletState& a, const DropletState& b) {
      return (a.position - b.position).abs().maxCoeff();
    };
    const auto velocity_error = [](const DropletState& a, const DropletState& b) {
      return (a.velocity - b.velocity).abs().maxCoeff() / b.velocity.abs().maxCoeff();
    };
    use_instruction_set(instruction_sets().back());
    const DropletState baseline = readable_form();
    for (const std::string& set : instruction_sets()) {
      use_instruction_set(set);
      const DropletState readable = readable_form();
      EXPECT_LT(position_error(readable, baseline), 1e-14) << set << ", " << vertices;
      EXPECT_LT(velocity_error(readable, baseline), 3e-12) << set << ", " << vertices;
      DpDroplet droplet(run, walls, initial);
      ASSERT_GT(droplet.potential_energy().self_contact, 0);
      if (run.dp.wall_contact == WallContact::edge) {
        ASSERT_GT(droplet.potential_energy().wall, 0);
      }
      droplet.advance(3);
      ASSERT_EQ(droplet.num_integrated_steps(), 3) << "the reference has no sub-steps";
      EXPECT_LT(position_error(droplet.state(), readable), 1e-14) << set << ", " << vertices;
      EXPECT_LT(velocity_error(droplet.state(), readable), 3e-12) << set << ", " << vertices;
    }
  }
}

TEST(InstructionSets, HaveDifferentNames) {
  // Every name must be listed once, because use_instruction_set() selects a set by its name.
  const std::vector<std::string> names = instruction_sets();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST_P(Step, JoinsStepsOfDifferentLengths) {
  // Two consecutive steps share one half kick, whether their lengths are equal or not.
  for (const int vertices : {64, 101}) {
    const auto [run, initial, walls] = touching_droplet(vertices);
    constexpr double long_step = 1e-3, short_step = 0.3e-3;
    // Each entry makes one step, because the rates of the near-wall drag are updated between entries.
    std::vector<Steps> all;
    all.reserve(9);
    for (int k = 0; k < 9; ++k) all.push_back({1, k % 3 == 1 ? short_step : long_step});
    for (const std::string& set : instruction_sets()) {
      use_instruction_set(set);
      DpForces forces(run, walls);
      DpStepper stepper(run, walls, forces);
      DropletState joined = initial, apart = initial;
      stepper.move(joined, all, nullptr);
      for (const Steps& steps : all) stepper.move(apart, {{steps}}, nullptr);
      ASSERT_GT((joined.position - initial.position).abs().maxCoeff(), 1e-5);
      EXPECT_LT((joined.position - apart.position).abs().maxCoeff(), 1e-14) << set << ", " << vertices;
      EXPECT_LT((joined.velocity - apart.velocity).abs().maxCoeff(), 1e-11 * apart.velocity.abs().maxCoeff())
          << set << ", " << vertices;
    }
  }
}

TEST_P(Step, IsThatOfTheReadableFormWithAnImplicitPressure) {
  for (const int vertices : {64, 101}) {
    auto [run, initial, walls] = touching_droplet(vertices);
    run.drag.near_wall = 0;  // with near-wall drag the pressure would never be implicit
    constexpr int num_steps = 3;
    for (const std::string& set : instruction_sets()) {
      use_instruction_set(set);
      ReadableDroplet readable(run, walls, initial, Pressure::implicit);
      for (int step = 0; step < num_steps; ++step) readable.step();
      DpForces forces(run, walls);
      DpStepper stepper(run, walls, forces);
      DropletState state = initial, without = initial;
      stepper.move(state, {{{num_steps, *run.time_step, Pressure::implicit}}}, nullptr);
      stepper.move(without, {{{num_steps, *run.time_step}}}, nullptr);
      EXPECT_LT((state.position - readable.state().position).abs().maxCoeff(), 1e-14) << set;
      const double fastest = readable.state().velocity.abs().maxCoeff();
      EXPECT_LT((state.velocity - readable.state().velocity).abs().maxCoeff(), 3e-12 * fastest) << set;
      EXPECT_GT((state.velocity - without.velocity).abs().maxCoeff(), 1e-4 * fastest)
          << "the pressure adds something";
    }
  }
}

TEST_P(Step, MeetsContactsThatBeginBetweenTwoLooks) {
  // A neck closes within 32 steps and opens again. The contours have various first vertices and last edges.
  for (const int vertices : {64, 97, 101, 256}) {
    const RunParameters run = parameters(vertices);
    const double diameter = units::regular_edge_length(vertices);
    DropletState initial = state_of(renumbered(
        shaken(full_size_dumbbell(vertices, 1.03 * diameter), 0.002 * diameter), vertices / 4 + 1));
    initial.velocity.tail(vertices) =
        -30 * diameter * initial.y().sign() * (-(initial.x() / 0.2).square()).exp();
    const ObstacleArray walls(20, {{-1.5, 0, 0.15}});
    ReadableDroplet readable(run, walls, initial);
    double deepest = 0;
    for (int step = 0; step < 40; ++step) {
      readable.step();
      deepest = std::max(deepest, DpDroplet(run, walls, readable.state()).potential_energy().self_contact);
    }
    ASSERT_GT(deepest, 0);
    for (const std::string& set : instruction_sets()) {
      use_instruction_set(set);
      DpDroplet droplet(run, walls, initial);
      ASSERT_EQ(droplet.potential_energy().self_contact, 0);
      droplet.advance(40);
      ASSERT_EQ(droplet.num_integrated_steps(), 40) << "the reference has no sub-steps";
      EXPECT_LT((droplet.state().position - readable.state().position).abs().maxCoeff(), 1e-12)
          << set << ", " << vertices;
    }
  }
}

TEST_P(Step, MeetsCirclesThatShareEdges) {
  // The circles around the droplet are so close together that most edges touch two of them. The edges where
  // the contour begins and ends are among these edges. Some contours have few vertices.
  std::size_t num_compared = 0;
  for (const int vertices : {16, 30, 64, 101}) {
    RunParameters run = parameters(64);
    run.dp.vertices = vertices;
    run.wall_stiffness = wall_stiffness(200, units::regular_edge_length(vertices));
    const double edge = units::regular_edge_length(vertices), radius = 0.5 * edge;
    DropletState initial = state_of(shaken(regular_polygon(vertices, units::rest_area), 0.01 * edge));
    initial.velocity.head(vertices) = 0.05;
    std::vector<Obstacle> circles;
    for (double angle = 0; angle < 6; angle += 1.1 * edge) {
      const double far = 0.5 + radius + *run.dp.contact_range - 0.12 * edge;
      circles.push_back({far * std::cos(angle), far * std::sin(angle), radius});
    }
    const ObstacleArray walls(20, std::move(circles));
    ReadableDroplet readable(run, walls, initial);
    constexpr int num_steps = 10;
    for (int step = 0; step < num_steps; ++step) readable.step();
    if (run.dp.friction > 0) {
      ASSERT_FALSE(readable.state().anchors.empty());
    }
    for (const std::string& set : instruction_sets()) {
      use_instruction_set(set);
      DpDroplet droplet(run, walls, initial);
      if (run.dp.wall_contact == WallContact::edge) {
        ASSERT_GT(droplet.potential_energy().wall, 0);
      }
      droplet.advance(num_steps);
      if (droplet.num_integrated_steps() != num_steps) continue;  // the reference has no sub-steps
      ++num_compared;
      expect_same_anchors(droplet.state(), readable.state());
      EXPECT_LT((droplet.state().position - readable.state().position).abs().maxCoeff(), 1e-14)
          << set << ", " << vertices;
    }
  }
  EXPECT_GE(num_compared, 2 * instruction_sets().size());
}

/// A circle that touches the upper side of a droplet's neck near `x`.
Obstacle on_neck(const DropletState& state, double x, double radius, double distance) {
  double y = 0;
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    const double across = state.x()[i] - x, reach = radius + distance;
    if (state.y()[i] > 0 && std::abs(across) < reach)
      y = std::max(y, state.y()[i] + std::sqrt(reach * reach - across * across));
  }
  return {x, y, radius};
}

TEST_P(Step, HoldsAThinNeckThroughItsFilm) {
  // The neck touches itself, and one or two circles. The circles touch both layers of the neck. The contour
  // begins in a lobe or in the neck.
  int num_held = 0;
  for (const int vertices : {64, 101, 256}) {
    const RunParameters run = parameters(vertices);
    const double diameter = units::regular_edge_length(vertices);
    for (const bool are_two : {false, true}) {
      DropletState initial =
          state_of(renumbered(shaken(full_size_dumbbell(vertices, 0.98 * diameter), 0.002 * diameter),
                              are_two ? vertices / 4 : 0));
      initial.velocity = shaken(Eigen::ArrayXd::Zero(initial.position.size()), 0.03, 7);
      std::vector<Obstacle> circles = {on_neck(initial, 0.01, are_two ? 0.025 : 0.1, 0.466 * diameter)};
      if (are_two) circles.push_back(on_neck(initial, -0.05, 0.025, 0.466 * diameter));
      const ObstacleArray walls(20, circles);
      ReadableDroplet readable(run, walls, initial);
      constexpr int num_steps = 10;
      for (int step = 0; step < num_steps; ++step) {
        readable.step();
        if (run.dp.friction > 0) num_held += num_behind_films(readable.state());
      }
      for (const std::string& set : instruction_sets()) {
        use_instruction_set(set);
        DpDroplet droplet(run, walls, initial);
        ASSERT_GT(droplet.potential_energy().self_contact, 0);
        droplet.advance(num_steps);
        ASSERT_EQ(droplet.num_integrated_steps(), num_steps) << "the reference has no sub-steps";
        expect_same_anchors(droplet.state(), readable.state());
        EXPECT_LT((droplet.state().position - readable.state().position).abs().maxCoeff(), 1e-13)
            << set << ", " << vertices;
      }
    }
  }
  EXPECT_EQ(num_held > 20, parameters(64).dp.film_friction == FilmFriction::on) << num_held;
}

INSTANTIATE_TEST_SUITE_P(
    Interfaces, Step,
    testing::Values(StepCase{"robust", [](RunParameters&) {}},
                    StepCase{"robust_near_walls", [](RunParameters& r) { r.drag.near_wall = 0.1; }},
                    StepCase{"other_exponent",
                             [](RunParameters& r) {
                               r.drag.near_wall = 0.1;
                               r.drag.near_wall_exponent = 1.1;
                               r.drag.relative = 3;
                             }},
                    StepCase{"mean_springs",
                             [](RunParameters& r) {
                               r.dp.perimeter_spring = PerimeterSpring::mean;
                               r.dp.gravity = Gravity::vertex;
                             }},
                    StepCase{"rest_springs_near_walls",
                             [](RunParameters& r) {
                               make_elastic(r);
                               r.drag.near_wall = 0.1;
                               r.drag.relative = 2;
                             }},
                    StepCase{"vertex_contact",
                             [](RunParameters& r) { r.dp.wall_contact = WallContact::vertex; }},
                    StepCase{"wetted", [](RunParameters& r) { r.dp.wall_tension = 0.5; }},
                    StepCase{"hysteresis",
                             [](RunParameters& r) {
                               r.dp.wall_tension = 0.5;
                               r.dp.receding_angle = 100;
                               r.dp.advancing_angle = 140;
                             }},
                    StepCase{"friction",
                             [](RunParameters& r) {
                               make_elastic(r);
                               r.dp.friction = 0.1;
                             }},
                    StepCase{"friction_through_films",
                             [](RunParameters& r) {
                               make_elastic(r);
                               r.dp.friction = 0.1;
                               r.dp.film_friction = FilmFriction::on;
                             }},
                    StepCase{"friction_and_traction",
                             [](RunParameters& r) {
                               make_elastic(r);
                               r.dp.friction = 0.05;
                               r.dp.yield_traction = 0.1;
                               r.dp.film_friction = FilmFriction::on;
                             }}),
    [](const auto& tested) { return tested.param.name; });

TEST(InstructionSet, DecidesTheForcesOfReleasesToo) {
  // Another instruction set adds numbers in another order and rounds less often, so some bits differ.
  RunParameters run;
  run.dp.vertices = 256;
  run.dp.line_tension = 0.3;
  run = resolve(run);
  const DropletState state = state_of(shaken(dumbbell(256, 0.1), 0.002));
  const ObstacleArray walls(20, {});
  const auto force_with = [&](const std::string& set) {
    use_instruction_set(set);
    DpForces forces(run, walls);
    RestForces rest_forces(run, forces);
    rest_forces.update_contacts(state, {});
    Eigen::ArrayXd force(state.position.size());
    rest_forces.evaluate(state, force);
    use_instruction_set("auto");
    return force;
  };
  std::vector<std::string> others = instruction_sets();
  const Eigen::ArrayXd baseline = force_with(others.back());
  others.pop_back();
  for (const std::string& set : others) EXPECT_TRUE((force_with(set) != baseline).any()) << set;
}

TEST(InstructionSet, OfAnotherProcessorIsRefused) {
  EXPECT_THROW(use_instruction_set("avx1024"), Error);
  EXPECT_EQ(instruction_set(), instruction_sets().front());
}

}  // namespace
}  // namespace clog

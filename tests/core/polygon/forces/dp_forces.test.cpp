#include "clog/core/polygon/forces/dp_forces.hpp"
#include "clog/core/run/resolve.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "polygon/forces/reference_forces.hpp"
#include "support.hpp"

namespace clog {
namespace {

using namespace test;

/// Parameters that switch off all terms of the interface, except for those that `switch_on` adds.
RunParameters only(void (*switch_on)(RunParameters&), int vertices = 64) {
  RunParameters run = bare_parameters(vertices);
  run.dp.line_tension = 0;
  run.dp.area_stiffness = 0;
  run.dp.perimeter_stiffness = 0;
  run.dp.self_contact = SelfContact::off;
  switch_on(run);
  return run;
}

/// The tests take the central difference of an energy of order one with the step h = 1e-6. The rounding error
/// of this difference is about 1e-9; the truncation error, h^2 U''', is smaller.
constexpr double difference_tolerance = 2e-7;

double free_force_error(const RunParameters& run, double weight = 0) {
  const ObstacleArray nothing = no_obstacles();
  ReferenceForces forces(run, nothing);
  forces.set_weight(weight);
  return force_error(forces, state_of(shaken(regular_polygon(*run.dp.vertices, 0.8), 0.003)));
}

TEST(DpForces, AreaTermIsTheGradientOfItsEnergy) {
  EXPECT_LT(free_force_error(only([](RunParameters& run) { run.dp.area_stiffness = 50; })),
            difference_tolerance);
}

TEST(DpForces, LineTensionIsTheGradientOfItsEnergy) {
  EXPECT_LT(free_force_error(only([](RunParameters& run) { run.dp.line_tension = 1.3; })),
            difference_tolerance);
}

TEST(DpForces, SpringsToTheRestLengthAreTheGradientOfTheirEnergy) {
  EXPECT_LT(free_force_error(only([](RunParameters& run) {
              run.dp.perimeter_stiffness = 0.7;
              run.dp.perimeter_spring = PerimeterSpring::rest;
            })),
            difference_tolerance);
}

TEST(DpForces, SpringsToTheMeanLengthAreTheGradientOfTheirEnergy) {
  EXPECT_LT(free_force_error(only([](RunParameters& run) { run.dp.perimeter_stiffness = 0.7; })),
            difference_tolerance);
}

TEST(DpForces, WeightOnTheVerticesIsTheGradientOfItsEnergy) {
  EXPECT_LT(free_force_error(only([](RunParameters&) {}), 0.6), difference_tolerance);
}

TEST(DpForces, WeightOnTheAreaIsTheGradientOfItsEnergy) {
  EXPECT_LT(free_force_error(only([](RunParameters& run) { run.dp.gravity = Gravity::area; }), 0.6),
            difference_tolerance);
}

TEST(DpForces, WeightOnTheAreaSumsToTheWholeWeight) {
  const ObstacleArray nothing = no_obstacles();
  ReferenceForces forces(only([](RunParameters& run) { run.dp.gravity = Gravity::area; }), nothing);
  DropletState state = state_of(shaken(regular_polygon(64, 0.8), 0.01));
  forces.update_contacts(state, {});
  Eigen::ArrayXd force(128);
  forces.evaluate(state, force);
  EXPECT_NEAR(force.head(64).sum(), units::droplet_mass, 1e-12);
  EXPECT_NEAR(force.tail(64).sum(), 0, 1e-12);
}

TEST(DpForces, WallContactIsTheGradientOfItsEnergy) {
  // The second obstacle has a periodic image at x = -0.6, which touches the droplet.
  const ObstacleArray wall(20, {{0.65, 0.05, 0.15}, {19.4, 0.1, 0.15}});
  ReferenceForces forces(only([](RunParameters&) {}), wall);
  forces.set_weight(0);
  const DropletState state = state_of(shaken(regular_polygon(64, 0.8), 0.003));
  forces.update_contacts(state, {});
  ASSERT_GT(forces.energy(state).wall, 0);
  // The tolerance is larger by the contact's stiffness of 1000.
  EXPECT_LT(force_error(forces, state), 1e-5);
}

TEST(DpForces, SelfContactIsTheGradientOfItsEnergy) {
  const ObstacleArray nothing = no_obstacles();
  ReferenceForces forces(only([](RunParameters& run) { run.dp.self_contact = SelfContact::on; }, 256),
                         nothing);
  forces.set_weight(0);
  const DropletState state = state_of(shaken(dumbbell(256, 0.006), 1e-4));
  forces.update_contacts(state, {});
  ASSERT_GT(forces.energy(state).self_contact, 0);
  EXPECT_LT(force_error(forces, state), 1e-5);
}

TEST(DpForces, AllTermsTogetherAreTheGradientOfTheTotalEnergy) {
  const ObstacleArray wall(20, {{0, 0.34, 0.15}});
  RunParameters run = bare_parameters(256);
  run.dp.area_stiffness = 50;
  ReferenceForces forces(run, wall);
  const DropletState state = state_of(shaken(dumbbell(256, 0.006), 1e-4));
  EXPECT_LT(force_error(forces, state), 2e-5);
}

TEST(DpForces, InternalForcesExertNoNetForceAndNoTorque) {
  const ObstacleArray nothing = no_obstacles();
  ReferenceForces forces(bare_parameters(256), nothing);
  forces.set_weight(0);
  const DropletState state = state_of(shaken(dumbbell(256, 0.006), 1e-4));
  forces.update_contacts(state, {});
  Eigen::ArrayXd force(512);
  forces.evaluate(state, force);
  const double scale = force.abs().sum();
  EXPECT_NEAR(force.head(256).sum() / scale, 0, 1e-13);
  EXPECT_NEAR(force.tail(256).sum() / scale, 0, 1e-13);
  EXPECT_NEAR((state.x() * force.tail(256) - state.y() * force.head(256)).sum() / scale, 0, 1e-13);
}

TEST(DpForces, SpringsAlongTheInterfaceDoNotPushTheDroplet) {
  // A spring along the interface pulls a vertex against the liquid, not against the neighbouring vertices.
  // The sum of all forces must be the weight alone.
  const ObstacleArray nothing = no_obstacles();
  RunParameters run;
  run.dp.vertices = 64;
  run.dp.perimeter_stiffness = 0.7;
  ReferenceForces forces(resolve(run), nothing);
  DropletState state = state_of(regular_polygon(64, 0.8));
  for (int i = 0; i < 64; ++i) {
    // The vertices are closer together on one side of the ellipse.
    const double angle = 2 * std::numbers::pi * i / 64;
    state.position[i] = 0.6 * std::cos(angle + 0.5 * std::sin(angle));
    state.position[64 + i] = 0.4 * std::sin(angle + 0.5 * std::sin(angle));
  }
  Eigen::ArrayXd force(128);
  forces.evaluate(state, force);
  EXPECT_NEAR(force.head(64).sum(), units::droplet_mass * units::gravity, 1e-10);
  EXPECT_NEAR(force.tail(64).sum(), 0, 1e-10);
}

TEST(DpForces, AMirroredDropletFeelsMirroredForces) {
  const int n = 256;
  const ObstacleArray wall(20, {{0.2, 0.3, 0.15}});
  const ObstacleArray mirrored_wall(20, {{0.2, -0.3, 0.15}});
  const Eigen::ArrayXd position = shaken(dumbbell(n, 0.006), 1e-4);
  // y is reversed. The order of the vertices is reversed, too, so that it stays counter-clockwise.
  Eigen::ArrayXd mirrored(2 * n);
  mirrored.head(n) = position.head(n).reverse();
  mirrored.tail(n) = -position.tail(n).reverse();
  const auto force_on = [](const ObstacleArray& obstacles, const Eigen::ArrayXd& p) {
    ReferenceForces forces(bare_parameters(n), obstacles);
    const DropletState state = state_of(p);
    forces.update_contacts(state, {});
    Eigen::ArrayXd force(2 * n);
    forces.evaluate(state, force);
    return force;
  };
  const Eigen::ArrayXd force = force_on(wall, position);
  const Eigen::ArrayXd mirrored_force = force_on(mirrored_wall, mirrored);
  const double scale = force.abs().maxCoeff();
  EXPECT_LT((mirrored_force.head(n).reverse() - force.head(n)).abs().maxCoeff() / scale, 1e-12);
  EXPECT_LT((mirrored_force.tail(n).reverse() + force.tail(n)).abs().maxCoeff() / scale, 1e-12);
}

TEST(DpForces, LaplacePressureOfACircleIsLineTensionOverRadius) {
  // On a regular polygon of circumradius R, tension and pressure balance if p = gamma/(R cos(pi/n)).
  RunParameters run = only([](RunParameters& r) { r.dp.line_tension = 2, r.dp.area_stiffness = 1e4; });
  const ObstacleArray nothing = no_obstacles();
  ReferenceForces forces(run, nothing);
  forces.set_weight(0);
  const int n = *run.dp.vertices;
  const Eigen::ArrayXd position = regular_polygon(n, 0.6);
  const double inner_radius = position[0] * std::cos(std::numbers::pi / n);
  forces.set_rest_area(0.6 + 2 / inner_radius / *run.dp.area_stiffness);
  const DropletState state = state_of(position);
  Eigen::ArrayXd force(2 * n);
  forces.evaluate(state, force);
  EXPECT_LT(force.abs().maxCoeff(), 1e-11);
}

class ContactLists : public testing::TestWithParam<double> {};
// The smallest speed is that of a sinking droplet. Contact lists have a margin, the skin. At the largest
// speed, a droplet moves by more than the usual skin between two updates.
INSTANTIATE_TEST_SUITE_P(Speeds, ContactLists, testing::Values(0.05, 0.8, 5.0));

TEST_P(ContactLists, MissNothingWhileTheDropletMoves) {
  // Compares the forces with those of all obstacles and their images. The droplet drifts through the array.
  ObstacleParameters parameters{.gap = 0.2, .diameter = 0.3, .density = {}, .box = 12.5};
  const ObstacleArray array = sample_obstacles(parameters, 5);
  RunParameters run = only([](RunParameters& r) { r.drag.near_wall = 0.1; });
  ReferenceForces forces(run, array);
  forces.set_weight(0);
  DropletState state = state_of(regular_polygon(64, 0.8), 12.5);
  state.velocity.head(64).setConstant(GetParam());
  state.velocity.tail(64).setConstant(0.03);
  Eigen::ArrayXd force(128);
  const double range = forces.contact_range();
  const double cutoff = run.drag.near_wall_cutoff;
  const double stiffness = contact_stiffness(*run.wall_stiffness, 2 * range);
  for (int step = 0; step < 2000; ++step) {
    // The lists are updated only in every other step, so the forces in the other steps depend on the skin.
    if (step % 2 == 0) {
      if (state.recentre().any()) forces.forget_contacts();
      forces.update_contacts(state, state.possible_travel(0.2));
    }
    state.position += 0.1 * state.velocity;
    if (step % 50 != 7) continue;
    forces.evaluate(state, force);
    Eigen::Array<double, 64, 2> expected = Eigen::Array<double, 64, 2>::Zero();
    Eigen::Array<double, 64, 1> nearest = Eigen::Array<double, 64, 1>::Constant(1e9);
    for (const Obstacle& obstacle : array.obstacles())
      for (int image = 0; image < 9; ++image) {
        const int column = image % 3 - 1, row = image / 3 - 1;
        const Eigen::Array2d centre(obstacle.x + 12.5 * column, obstacle.y + 12.5 * row);
        for (int i = 0; i < 64; ++i) {
          const int next = (i + 1) % 64;
          const auto vertex = [&](int k) {
            return Eigen::Array2d(state.frame.origin + Eigen::Array2d(state.x()[k], state.y()[k]));
          };
          const Eigen::Array2d begin = vertex(i), end = vertex(next);
          nearest[i] = std::min(nearest[i], (begin - centre).matrix().norm() - obstacle.radius);
          // Each half of the refined edge pushes separately. The middle passes its push on to four vertices.
          const int before = (i + 63) % 64, after = (i + 2) % 64;
          const Eigen::Array2d middle =
              (9 * (vertex(i) + vertex(next)) - vertex(before) - vertex(after)) / 16;
          const auto push = [&](const Eigen::Array2d& from, const Eigen::Array2d& to) {
            const double distance = distance_to_segment(centre, from, to) - obstacle.radius;
            const Eigen::Array2d half = to - from;
            const double fraction =
                std::clamp((half * (centre - from)).sum() / half.square().sum(), 0.0, 1.0);
            const Eigen::Array2d away = from + fraction * half - centre;
            const Eigen::Array2d whole =
                stiffness * std::max(0.0, range - distance) * away / away.matrix().norm();
            return std::pair<Eigen::Array2d, Eigen::Array2d>((1 - fraction) * whole, fraction * whole);
          };
          const auto [on_begin, on_middle] = push(begin, middle);
          const auto [also_on_middle, on_end] = push(middle, end);
          expected.row(i) += (on_begin + 9.0 / 16 * (on_middle + also_on_middle)).transpose();
          expected.row(next) += (on_end + 9.0 / 16 * (on_middle + also_on_middle)).transpose();
          expected.row(before) -= ((on_middle + also_on_middle) / 16).transpose();
          expected.row(after) -= ((on_middle + also_on_middle) / 16).transpose();
        }
      }
    for (int i = 0; i < 64; ++i) {
      EXPECT_NEAR(forces.wall_distance()[i], std::max(nearest[i], cutoff), 1e-12);
      EXPECT_NEAR(force[i], expected(i, 0), 1e-9 + 1e-10 * std::abs(expected(i, 0)));
      EXPECT_NEAR(force[64 + i], expected(i, 1), 1e-9 + 1e-10 * std::abs(expected(i, 1)));
    }
  }
}

TEST(DpForces, VertexContactIsTheGradientOfItsEnergy) {
  const ObstacleArray wall(20, {{0.62, 0.05, 0.15}, {-0.3, 0.5, 0.1}});
  ReferenceForces forces(only([](RunParameters& run) { run.dp.wall_contact = WallContact::vertex; }), wall);
  const DropletState state = state_of(shaken(regular_polygon(64, 0.8), 0.003));
  forces.update_contacts(state, {});
  ASSERT_GT(forces.energy(state).wall, 0);
  EXPECT_LT(force_error(forces, state), 1e-5);
}

/// Two wedges: one presses into the droplet with its tip, the other with its flank.
ObstacleArray two_wedges(double radius) {
  return ObstacleArray(20, {},
                       {{.tip = {0.02, 0.47}, .axis = {0, 1}, .half_angle = 0.6, .radius = radius},
                        {.tip = {0.4, -0.6}, .axis = {0.6, -0.8}, .half_angle = 1.3, .radius = radius}});
}

TEST(DpForces, WedgesPushWithTheGradientOfTheirEnergy) {
  for (const double radius : {0.0, 0.05})
    for (const WallContact contact : {WallContact::edge, WallContact::vertex}) {
      const ObstacleArray wall = two_wedges(radius);
      RunParameters run = only([](RunParameters&) {});
      run.dp.wall_contact = contact;
      ReferenceForces forces(run, wall);
      const DropletState state = state_of(shaken(regular_polygon(64, 0.8), 0.003));
      forces.update_contacts(state, {});
      ASSERT_GT(forces.energy(state).wall, 1e-3);
      EXPECT_LT(force_error(forces, state), 1e-4) << "radius " << radius;
    }
}

TEST(DpForces, WettedWallsPullWithTheGradientOfTheirEnergy) {
  const ObstacleArray wall(20, {{0.69, 0.05, 0.15}}, {{.tip = {0, 0.52}, .axis = {0, 1}}});
  RunParameters run = only([](RunParameters& r) { r.dp.line_tension = 1.3; });
  run.dp.wall_tension = 0.2;
  run.dp.perimeter_spring = PerimeterSpring::mean;
  ReferenceForces forces(run, wall);
  const DropletState state = state_of(shaken(regular_polygon(64, 0.8), 0.003));
  EXPECT_LT(force_error(forces, state), 1e-5);
  const double dry = 1.3 * polygon_shape(state.position).perimeter;
  EXPECT_LT(forces.energy(state).line_tension, dry - 0.01);
}

TEST(DpForces, WettedWallsNeitherPullAlongTheInterfaceNorAlongTheWall) {
  // A wetted wall changes the tension along the interface. The springs along the interface do not balance
  // this change. The edges of the polygon carry a part of the change, and the liquid takes the rest. The
  // sum of all forces along a flat wall must be zero.
  const ObstacleArray wall(20, {}, {{.tip = {0.37, 0}, .axis = {1, 0}, .half_angle = std::numbers::pi / 2}});
  RunParameters run = only([](RunParameters& r) { r.dp.line_tension = 1.3; });
  run.dp.perimeter_spring = PerimeterSpring::along;
  run.dp.gravity = Gravity::area;
  const DropletState state = state_of(shaken(regular_polygon(64, 0.8), 0.003));
  const auto force_at = [&](double wall_tension) {
    run.dp.wall_tension = wall_tension;
    ReferenceForces forces(run, wall);
    forces.set_weight(0);
    forces.update_contacts(state, {});
    Eigen::ArrayXd force(128);
    forces.evaluate(state, force);
    return force;
  };
  const Eigen::ArrayXd wetting = force_at(0.2) - force_at(1);
  EXPECT_GT(wetting.head(64).sum(), 0.1);
  EXPECT_NEAR(wetting.tail(64).sum(), 0, 1e-12);
}

TEST(DpForces, SpringsAlongTheInterfaceChangeNeitherAreaNorAnEvenContour) {
  RunParameters run = only([](RunParameters& r) {
    r.dp.perimeter_stiffness = 0.7;
    r.dp.perimeter_spring = PerimeterSpring::along;
    r.dp.gravity = Gravity::vertex;
  });
  const ObstacleArray nothing = no_obstacles();
  ReferenceForces forces(run, nothing);
  forces.set_weight(0);
  Eigen::ArrayXd force(128);
  forces.evaluate(state_of(regular_polygon(64, 0.8)), force);
  EXPECT_LT(force.abs().maxCoeff(), 1e-13);

  const DropletState uneven = state_of(shaken(regular_polygon(64, 0.8), 0.01));
  forces.evaluate(uneven, force);
  EXPECT_GT(force.abs().maxCoeff(), 0.01);
  // The force on each vertex is along the chord of its neighbours.
  for (int i = 0; i < 64; ++i) {
    const int before = (i + 63) % 64, after = (i + 1) % 64;
    const double chord_x = uneven.x()[after] - uneven.x()[before];
    const double chord_y = uneven.y()[after] - uneven.y()[before];
    EXPECT_NEAR(force[i] * chord_y - force[64 + i] * chord_x, 0, 1e-13);
  }
}

TEST(DpForces, AreTheSameSixThousandDiametersDownstream) {
  // Coordinates are shifted to keep digits. Without shifts, as in the published method, an edge would lose
  // five to six of its 16 digits so far downstream.
  const ObstacleArray array = sample_obstacles({.gap = 0.2, .diameter = 0.3, .density = {}, .box = 25}, 3);
  ReferenceForces near(bare_parameters(256), array);
  ReferenceForces far(bare_parameters(256), array);
  DropletState state = state_of(shaken(dumbbell(256, 0.006), 1e-4), 25);
  state.frame.origin = {3, 7};
  DropletState downstream = state;
  downstream.frame.image = {240, -3};
  Eigen::ArrayXd force(512), force_downstream(512);
  near.update_contacts(state, {});
  near.evaluate(state, force);
  far.update_contacts(downstream, {});
  far.evaluate(downstream, force_downstream);
  EXPECT_NEAR(downstream.frame.global({0, 0})[0], 6003, 1e-9);
  EXPECT_LE((force - force_downstream).abs().maxCoeff(), 1e-12 * force.abs().maxCoeff());

  // The same droplet in coordinates that are not shifted.
  const ObstacleArray nothing = no_obstacles(8000);
  ReferenceForces here(bare_parameters(256), nothing), there(bare_parameters(256), nothing);
  DropletState literal = state_of(state.position, 8000);
  here.update_contacts(literal, {});
  here.evaluate(literal, force);
  literal.x() += 6000;
  there.update_contacts(literal, {});
  there.evaluate(literal, force_downstream);
  EXPECT_GT((force - force_downstream).abs().maxCoeff(), 1e-11 * force.abs().maxCoeff());
}

TEST(DpForces, AnObstacleBetweenTwoVerticesIsPushedOffByTheirEdge) {
  // A box with a lower edge that spans an obstacle. The obstacle touches no vertex.
  Eigen::ArrayXd position(32);
  for (int i = 0; i < 16; ++i) {
    const int side = i / 4;
    const double along = i % 4 / 4.0 * 2 - 1;
    position[i] = side == 0 ? along : side == 1 ? 1 : side == 2 ? -along : -1;
    position[16 + i] = side == 0 ? -1 : side == 1 ? along : side == 2 ? 1 : -along;
  }
  const RunParameters run = only([](RunParameters&) {}, 16);
  const double range = units::regular_edge_length(16) / 2;
  // The obstacle is below the middle of edge 1, which goes from (-0.5, -1) to (0, -1). The edge is 0.1 inside
  // the contact range of the obstacle's surface.
  const ObstacleArray obstacle(20, {{19.75, 20 - 1 - 0.05 - range + 0.1, 0.05}});
  ReferenceForces forces(run, obstacle);
  forces.set_weight(0);
  const DropletState state = state_of(position);
  forces.update_contacts(state, {});
  Eigen::ArrayXd force(32);
  forces.evaluate(state, force);
  const double push = contact_stiffness(*run.wall_stiffness, 2 * range) * 0.1;
  EXPECT_NEAR(forces.deepest_overlap(state), 0.1, 1e-12);
  EXPECT_GE(force[16 + 1], 0.5 * push - 1e-9);
  EXPECT_GE(force[16 + 2], 0.5 * push - 1e-9);
  EXPECT_NEAR(force.head(16).sum(), 0, 1e-9);
}

}  // namespace
}  // namespace clog

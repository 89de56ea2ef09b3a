#include "clog/core/disk/sp_droplet.hpp"

#include <gtest/gtest.h>

#include "clog/core/tools/units.hpp"
#include "support.hpp"

namespace clog {
namespace {

RunParameters free_disk(double wall_stiffness, double time_step = 1e-3) {
  RunParameters run;
  run.model = Model::sp;
  run.wall_stiffness = wall_stiffness;
  run.time_step = time_step;
  run.obstacles.box = 20;
  return run;
}

DropletState disk_at(double x, double y) {
  Eigen::ArrayXd position(2);
  position << x, y;
  return test::state_of(position);
}

TEST(SpDroplet, RestsOnAnObstacleAtTheAnalyticSag) {
  // With k = 4 E_w/sigma^2, the contact balances the weight M g = pi/4 at an overlap of pi/(16 E_w).
  for (const double stiffness : {0.5, 3.0, 30.0}) {
    const ObstacleArray obstacle(20, {{2, 0, 0.15}});
    SpDroplet droplet(free_disk(stiffness), obstacle, disk_at(1.35, 0));
    droplet.advance(600000);  // 45 times the slowest relaxation time, M g/(k V_t)
    EXPECT_NEAR(droplet.state().position[0] + droplet.state().frame.origin[0] - 1.35,
                std::numbers::pi / (16 * stiffness), 1e-9);
    EXPECT_LT(droplet.kinetic_energy(), 1e-20);
  }
}

TEST(SpDroplet, FollowsTheDampedOscillatorToSecondOrder) {
  // Head-on contact is linear: M x'' = M g - b x' - k x. The disk starts at rest at x = 0, and oscillates
  // with these parameters.
  const double stiffness = 30;
  const double k = 4 * stiffness;
  const double mass = units::droplet_mass;
  const double terminal_speed = 0.3;
  const double rate = 1 / (2 * terminal_speed);
  const double omega = std::sqrt(k / mass - rate * rate);
  const double sag = mass / k;
  const double end = 0.512;
  const double exact =
      sag * (1 - std::exp(-rate * end) * (std::cos(omega * end) + rate / omega * std::sin(omega * end)));
  const auto error_at = [&](double dt) {
    const ObstacleArray obstacle(20, {{2, 0, 0.15}});
    RunParameters run = free_disk(stiffness, dt);
    run.drag.terminal_speed = terminal_speed;
    SpDroplet droplet(run, obstacle, disk_at(1.35, 0));
    droplet.advance(static_cast<int>(std::lround(end / dt)));
    return std::abs(droplet.state().position[0] + droplet.state().frame.origin[0] - 1.35 - exact);
  };
  const double coarse = error_at(4e-3);
  const double fine = error_at(2e-3);
  EXPECT_LT(fine, 1e-5);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);
}

TEST(SpDroplet, MeetsAnObstacleAtAnyAllowedStepAndSpeed) {
  // A head-on collision at speed 1 ends at the same place of rest with every time step.
  for (const double dt : {0.01, 0.05, 0.2}) {
    const ObstacleArray obstacle(20, {{8, 0, 0.15}});
    RunParameters run = free_disk(1, dt);
    run.drag.terminal_speed = 1;
    SpDroplet droplet(run, obstacle, disk_at(0, 0));
    droplet.advance(static_cast<int>(100 / dt));
    EXPECT_NEAR(droplet.state().frame.global(droplet.state().centre())[0], 7.35 + std::numbers::pi / 16, 1e-6)
        << dt;
  }
}

TEST(SpDroplet, ForceIsTheGradientOfTheEnergy) {
  const ObstacleArray obstacles(20, {{0.3, 0.1, 0.15}, {-0.2, 0.4, 0.3}, {19.9, 19.6, 0.1}});
  SpForces forces(free_disk(2), obstacles);
  DropletState state = disk_at(0.05, -0.03);
  forces.update_contacts(state, {});
  Eigen::ArrayXd force(2);
  forces.evaluate(state, force);
  for (int axis = 0; axis < 2; ++axis) {
    DropletState above = state;
    DropletState below = state;
    above.position[axis] += 1e-6;
    below.position[axis] -= 1e-6;
    EXPECT_NEAR(force[axis], -(forces.energy(above).total() - forces.energy(below).total()) / 2e-6, 1e-8);
  }
}

TEST(SpDroplet, ForceStaysFiniteInsideAnObstacle) {
  const ObstacleArray obstacle(20, {{0, 0, 0.15}});
  SpForces forces(free_disk(2), obstacle);
  forces.set_weight(0);
  Eigen::ArrayXd force(2);
  DropletState centre = disk_at(0, 0);
  forces.update_contacts(centre, {});
  forces.evaluate(centre, force);
  EXPECT_EQ(force[0], 0);
  DropletState inside = disk_at(0.05, 0);  // d = -0.1, so the force is 2 E_w (1 + 0.2)
  forces.evaluate(inside, force);
  EXPECT_NEAR(force[0], 2 * 2 * 1.2, 1e-12);
}

}  // namespace
}  // namespace clog

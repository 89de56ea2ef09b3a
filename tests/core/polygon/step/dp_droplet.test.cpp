#include "clog/core/polygon/step/dp_droplet.hpp"
#include "clog/core/run/resolve.hpp"

#include <gtest/gtest.h>

#include <tuple>

#include "polygon/forces/reference_forces.hpp"
#include "support.hpp"

namespace clog {
namespace {

using namespace test;

TEST(DpDroplet, ReachesTheTerminalSpeed) {
  RunParameters run = bare_parameters();
  const ObstacleArray nothing = no_obstacles();
  DpDroplet droplet(run, nothing, state_of(regular_polygon(64, units::rest_area)));
  droplet.advance(2000);  // 66 relaxation times
  EXPECT_NEAR(droplet.state().mean_velocity()[0], run.drag.terminal_speed, 1e-12);
  EXPECT_NEAR(droplet.state().mean_velocity()[1], 0, 1e-12);
}

TEST(DpDroplet, ApproachesTheTerminalSpeedExponentiallyWithSecondOrderError) {
  // In free fall with drag v = V (1 - exp(-g t/V)).
  const ObstacleArray nothing = no_obstacles();
  const auto error_at = [&](double dt) {
    RunParameters run = bare_parameters();
    run.time_step = dt;
    DpDroplet droplet(run, nothing, state_of(regular_polygon(64, units::rest_area)));
    droplet.advance(static_cast<int>(std::lround(0.064 / dt)));
    return std::abs(droplet.state().mean_velocity()[0] - 0.03 * (1 - std::exp(-0.064 / 0.03)));
  };
  const double coarse = error_at(2e-3);
  const double fine = error_at(1e-3);
  EXPECT_LT(fine, 1e-6);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.05);
}

TEST(DpDroplet, WithMoreInertiaApproachesTheSameTerminalSpeedLater) {
  // With the inertia S, v = V (1 - exp(-g t/(S V))).
  const ObstacleArray nothing = no_obstacles();
  for (const double inertia : {0.25, 1.0, 4.0}) {
    RunParameters run = bare_parameters();
    run.dp.inertia = inertia;
    run.time_step = 1e-4;
    DpDroplet droplet(run, nothing, state_of(regular_polygon(64, units::rest_area)));
    droplet.advance(640);
    const double speed = 0.03 * (1 - std::exp(-0.064 / (inertia * 0.03)));
    EXPECT_NEAR(droplet.centre_velocity()[0], speed, 1e-6) << inertia;
  }
}

TEST(DpDroplet, IsOfSecondOrderInTheTimeStepWithoutDrag) {
  const ObstacleArray nothing = no_obstacles();
  const auto position_at = [&](double dt) {
    RunParameters run = bare_parameters();
    run.drag.terminal_speed = no_drag;
    run.dp.area_stiffness = 100;
    run.time_step = dt;
    DpDroplet droplet(run, nothing, state_of(ellipse(64, 1.2)));
    const int steps = static_cast<int>(std::lround(0.4 / dt));
    droplet.advance(steps);
    EXPECT_EQ(droplet.num_integrated_steps(), steps) << "sub-steps would hide the order";
    return Eigen::ArrayXd(droplet.state().position);
  };
  const Eigen::ArrayXd exact = position_at(0.4 / 12800);
  const double coarse = (position_at(0.4 / 400) - exact).abs().maxCoeff();
  const double middle = (position_at(0.4 / 800) - exact).abs().maxCoeff();
  const double fine = (position_at(0.4 / 1600) - exact).abs().maxCoeff();
  EXPECT_LT(fine, 1e-5);
  EXPECT_NEAR(std::log2(coarse / middle), 2, 0.1);
  EXPECT_NEAR(std::log2(middle / fine), 2, 0.1);
}

RunParameters robust_polygon(int vertices) {
  RunParameters run = bare_parameters(vertices);
  run.dp.perimeter_spring = PerimeterSpring::along;
  run.dp.perimeter_stiffness = 0.3;
  run.dp.gravity = Gravity::area;
  return run;
}

TEST(DpDroplet, IsOfSecondOrderInTheTimeStepWithAreaDrag) {
  const ObstacleArray nothing = no_obstacles();
  const auto position_at = [&](double dt) {
    RunParameters run = robust_polygon(64);
    run.drag.terminal_speed = 0.3;
    run.dp.area_stiffness = 100;
    run.time_step = dt;
    DpDroplet droplet(run, nothing, state_of(ellipse(64, 1.2)));
    droplet.advance(static_cast<int>(std::lround(0.4 / dt)));
    return Eigen::ArrayXd(droplet.state().position);
  };
  const Eigen::ArrayXd exact = position_at(0.4 / 12800);
  const double coarse = (position_at(0.4 / 400) - exact).abs().maxCoeff();
  const double fine = (position_at(0.4 / 800) - exact).abs().maxCoeff();
  EXPECT_LT(fine, 1e-4);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.15);
}

TEST(DpDroplet, WithAreaDragFallsRoundAtTheTerminalSpeed) {
  // If weight and drag both act on the area, they do not pull along the interface, and the droplet remains a
  // circle.
  RunParameters run = robust_polygon(64);
  const ObstacleArray nothing = no_obstacles();
  DpDroplet droplet(run, nothing, state_of(regular_polygon(64, units::rest_area)));
  droplet.advance(20000);  // uneven vertices spread evenly at a rate of 0.5/t0
  const auto centroid = [&] {
    return droplet.state().frame.global(area_centroid(droplet.state().position))[0];
  };
  const double before = centroid();
  droplet.advance(3000);
  EXPECT_NEAR((centroid() - before) / 3, run.drag.terminal_speed, 1e-7);
  EXPECT_NEAR(droplet.shape().shape_parameter(), polygon_shape(regular_polygon(64, 0.7)).shape_parameter(),
              1e-9);
}

TEST(DpDroplet, FallsAtTheTerminalSpeedHoweverItsVerticesAreSpread) {
  const ObstacleArray nothing = no_obstacles(200);
  RunParameters run;
  run.dp.vertices = 64;
  run.dp.line_tension = 10;  // keeps the droplet round
  run = resolve(run);
  for (const double crowding : {-0.3, 0.3}) {
    DropletState state = state_of(regular_polygon(64, units::rest_area), 200);
    for (int i = 0; i < 64; ++i) {
      const double angle = 2 * std::numbers::pi * i / 64;
      state.position[i] = 0.5 * std::cos(angle + crowding * std::sin(angle));
      state.position[64 + i] = 0.5 * std::sin(angle + crowding * std::sin(angle));
    }
    DpDroplet droplet(run, nothing, state);
    droplet.advance(500);  // the vertices would need ten times this time to spread evenly
    EXPECT_NEAR(droplet.centre_velocity()[0] / run.drag.terminal_speed, 1, 0.01) << crowding;
  }
}

TEST(DpDroplet, RelativeDragDampsChangesOfShapeOnly) {
  // Drag on changes of shape makes a swinging ellipse lose energy faster, but does not change its fall.
  const ObstacleArray nothing = no_obstacles();
  const auto after = [&](double relative) {
    RunParameters run = bare_parameters();
    run.drag.relative = relative;
    run.drag.terminal_speed = 1;
    DpDroplet droplet(run, nothing, state_of(ellipse(64, 1.1)));
    droplet.advance(500);
    return std::pair(droplet.state().mean_velocity()[0], droplet.state().velocity.tail(64).matrix().norm());
  };
  const auto [fall, swing] = after(1);
  const auto [damped_fall, damped_swing] = after(10);
  EXPECT_NEAR(fall, 1 - std::exp(-0.5), 1e-6);
  EXPECT_NEAR(damped_fall, fall, 1e-9);
  EXPECT_LT(damped_swing, 0.7 * swing);
}

TEST(DpDroplet, BalancesItsEnergyToSecondOrder) {
  // The sum of E_k, U and the work against the drag must be conserved through a collision with an obstacle,
  // for every kind of drag, on dry and on wetted walls.
  const ObstacleArray wall(20, {{0.775, 0.05, 0.15}});
  for (const Gravity gravity : {Gravity::vertex, Gravity::area})
    for (const auto& [near_wall, wall_tension, inertia] :
         {std::tuple{0.0, 1.0, 1.0}, {0.05, 1.0, 1.0}, {0.0, 0.5, 1.0}, {0.05, 1.0, 4.0}}) {
      const auto imbalance = [&, near_wall = near_wall, wall_tension = wall_tension,
                              inertia = inertia](double dt) {
        RunParameters run = robust_polygon(64);
        run.dp.gravity = gravity;
        run.drag.near_wall = near_wall;
        run.dp.wall_tension = wall_tension;
        run.dp.inertia = inertia;
        run.drag.relative = 2;
        run.drag.terminal_speed = 0.5;
        run.dp.area_stiffness = 100;
        run.time_step = dt;
        DpDroplet droplet(run, wall, state_of(regular_polygon(64, units::rest_area)));
        droplet.measure_dissipation();
        const auto energy = [&] {
          return droplet.kinetic_energy() + droplet.potential_energy().total() + droplet.work().dissipated -
                 droplet.work().spreading;
        };
        const double begin = energy();
        double worst = 0;
        double contact = 0;
        const int times = inertia > 1 ? 20 : 10;  // a larger inertia delays the collision
        for (int i = 0; i < times; ++i) {
          droplet.advance(static_cast<int>(std::lround(0.08 / dt)));
          worst = std::max(worst, std::abs(energy() - begin));
          contact = std::max(contact, droplet.potential_energy().wall);
        }
        EXPECT_GT(contact, 1e-5);
        EXPECT_GT(droplet.work().dissipated, 0.01);
        return worst;
      };
      // The error also depends on the place within a step at which a contact begins. This scatter would hide
      // the effect of a single halving of the step, so the error is compared over four halvings.
      const double coarse = imbalance(8e-4);
      const double fine = imbalance(5e-5);
      EXPECT_LT(fine, 4e-6);
      EXPECT_GT(std::log2(coarse / fine) / 4, 1.6) << coarse << ' ' << fine;
    }
}

TEST(DpDroplet, ConservesEnergyWithoutDragToSecondOrder) {
  const ObstacleArray wall(20, {{0.9, 0.05, 0.15}});
  const auto drift = [&](double dt) {
    RunParameters run = bare_parameters();
    run.drag.terminal_speed = no_drag;
    run.dp.area_stiffness = 100;
    run.time_step = dt;
    DpDroplet droplet(run, wall, state_of(ellipse(64, 1.1)));
    const auto total = [&] { return droplet.kinetic_energy() + droplet.potential_energy().total(); };
    const double start = total();
    double worst = 0;
    for (int i = 0; i < 40; ++i) {
      droplet.advance(static_cast<int>(std::lround(0.02 / dt)));
      worst = std::max(worst, std::abs(total() - start));
    }
    EXPECT_GT(droplet.state().velocity.abs().maxCoeff(), 0.1);
    return worst;
  };
  const double coarse = drift(5e-4);
  const double fine = drift(2.5e-4);
  EXPECT_LT(fine, 1e-4);
  EXPECT_GT(coarse / fine, 3);
}

TEST(DpDroplet, SwingsAtTheFrequencyOfACapillaryMode) {
  // A circle with the line density mu = M/P has a small wave r = R + e cos 2 phi, which keeps the area. The
  // energy of the wave is (gamma/2R) int (r'^2 - r^2) dphi = 3 pi gamma e^2/(2R). The mass in motion is
  // pi mu R, so omega^2 = 3 gamma/(mu R^2).
  RunParameters run = bare_parameters(128);
  run.drag.terminal_speed = no_drag;
  run.dp.perimeter_stiffness = 0;
  run.dp.line_tension = 1;
  run.time_step = 5e-4;
  const ObstacleArray nothing = no_obstacles();
  constexpr double amplitude = 1e-4;
  const double radius = 0.5;
  Eigen::ArrayXd position(256);
  for (int i = 0; i < 128; ++i) {
    const double phi = 2 * std::numbers::pi * i / 128;
    const double r = radius + amplitude * std::cos(2 * phi);
    position[i] = r * std::cos(phi);
    position[128 + i] = r * std::sin(phi);
  }
  DpDroplet droplet(run, nothing, state_of(position));
  const auto mode = [&] {
    const Eigen::Array2d c = droplet.state().centre();
    double sum = 0;
    for (int i = 0; i < 128; ++i) {
      const double phi = 2 * std::numbers::pi * i / 128;
      sum +=
          std::hypot(droplet.state().x()[i] - c[0], droplet.state().y()[i] - c[1]) * std::cos(2 * phi) / 64;
    }
    return sum;
  };
  // A quarter period after the start, the amplitude passes through zero.
  const double line_density = units::droplet_mass / (2 * std::numbers::pi * radius);
  const double omega = std::sqrt(3.0 / (line_density * radius * radius));
  double before = mode();
  int step = 0;
  double now = before;
  while (now > 0 && step < 4000) {
    before = now;
    droplet.advance(1);
    now = mode();
    ++step;
  }
  const double quarter = (step - 1 + before / (before - now)) * *run.time_step;
  EXPECT_NEAR(quarter * omega / (std::numbers::pi / 2), 1, 0.02);
}

TEST(DpDroplet, FeelsBitIdenticalForcesAnyNumberOfBoxesDownstream) {
  const ObstacleArray array = sample_obstacles({.gap = 0.3, .diameter = 0.3, .density = {}, .box = 60.5}, 3);
  RunParameters run = bare_parameters();
  run.obstacles.box = 60.5;
  const auto after = [&](std::int64_t boxes) {
    DropletState state = state_of(regular_polygon(64, 0.05), 60.5);
    state.frame.origin = {59, 30};
    state.frame.image = {boxes, -boxes};
    DpDroplet droplet(run, array, state);
    droplet.advance(3000);
    return DropletState(droplet.state());
  };
  const DropletState near = after(0);
  const DropletState far = after(100);
  EXPECT_TRUE((near.position == far.position).all());
  EXPECT_TRUE((near.velocity == far.velocity).all());
}

TEST(DpDroplet, SplitsTheStepWhenStretchedTooFarForItWithoutDrag) {
  // The perimeter is 6 times that of a circle, so the area mode has omega dt = 2.1 at this step.
  RunParameters run = bare_parameters(256);
  run.drag.terminal_speed = no_drag;
  run.wall_stiffness = wall_stiffness(700, units::regular_edge_length(256));
  const ObstacleArray nothing = no_obstacles();
  const Eigen::ArrayXd long_film = ellipse(256, 9.5);
  DpDroplet film(run, nothing, state_of(long_film));
  ASSERT_GT(film.shape().perimeter, 6 * std::numbers::pi);
  film.advance(64);
  EXPECT_GT(film.num_integrated_steps(), 64);
  EXPECT_NEAR(film.shape().area, units::rest_area, 0.02);
  EXPECT_TRUE(film.state().position.allFinite());
}

TEST(DpDroplet, HasAnImplicitPressureWhenStretchedTooFarForTheStep) {
  // The film of the previous test, with drag. The step must be split only if the drag does not act on changes
  // of shape, or differs between vertices. Self-contact is off, because it would split steps of fast
  // vertices.
  RunParameters run = bare_parameters(256);
  run.dp.self_contact = SelfContact::off;
  run.wall_stiffness = wall_stiffness(700, units::regular_edge_length(256));
  const ObstacleArray nothing = no_obstacles();
  const auto num_steps = [&](double relative_drag) {
    run.drag.relative = relative_drag;
    DpDroplet film(run, nothing, state_of(ellipse(256, 9.5)));
    film.advance(64);
    EXPECT_NEAR(film.shape().area, units::rest_area, 0.02);
    EXPECT_TRUE(film.state().position.allFinite());
    return film.num_integrated_steps();
  };
  EXPECT_LT(num_steps(1), 1.2 * 64) << "only where its edges get short";
  EXPECT_GT(num_steps(0), 2 * 64);
  run.drag.near_wall = 0.1;
  EXPECT_GT(num_steps(1), 2 * 64);
}

TEST(DpDroplet, BlowsUpWhenStretchedAndNotSplit) {
  // The published scheme, with the film and the step of the previous test.
  RunParameters run = bare_parameters(256);
  run.wall_stiffness = wall_stiffness(700, units::regular_edge_length(256));
  const ObstacleArray nothing = no_obstacles();
  DropletState state = state_of(ellipse(256, 9.5));
  ReferenceForces forces(run, nothing);
  Eigen::ArrayXd force(2 * 256);
  forces.update_contacts(state, {.absolute = 1, .relative = 1});
  forces.evaluate(state, force);
  const double half_dt_over_m = 0.5 * *run.time_step / (units::droplet_mass / 256);
  for (int step = 0; step < 64; ++step) {
    state.velocity += half_dt_over_m * force;
    state.position += *run.time_step * state.velocity;
    forces.evaluate(state, force);
    state.velocity += half_dt_over_m * force;
  }
  EXPECT_FALSE(std::abs(polygon_shape(state.position).area - units::rest_area) < 0.4);
}

TEST(DpDroplet, IsSlowedByAWallAsTheDragLawSays) {
  // Far above an obstacle, the drag on the droplet depends only on the mean of (sigma/d)^(4/3) over the
  // vertices.
  RunParameters run = bare_parameters();
  run.drag.near_wall = 0.5;
  run.dp.line_tension = 10;  // keeps the droplet round
  run.time_step = 1e-3;
  const ObstacleArray wall(20, {{0, 3, 0.15}});
  DpDroplet droplet(run, wall, state_of(regular_polygon(64, units::rest_area)));
  droplet.advance(500);
  double drag = 0;
  for (int i = 0; i < 64; ++i) {
    const double distance = std::hypot(droplet.state().x()[i], droplet.state().y()[i] - 3) - 0.15;
    drag += (1 + 0.5 * std::pow(distance, -4.0 / 3.0)) / 64;
  }
  EXPECT_NEAR(droplet.state().mean_velocity()[0] / (0.03 / drag), 1, 1e-3);
}

}  // namespace
}  // namespace clog

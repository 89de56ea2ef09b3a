/// Steps with an implicit pressure against exact solutions and against short steps without one. That each of
/// them is what the documentation says is in dp_step.test.cpp.

#include <gtest/gtest.h>

#include <cmath>

#include "stepped_droplet.hpp"
#include "support.hpp"

namespace clog {
namespace {

using namespace test;

TEST(ImplicitPressure, LetsACircleBreatheAtTheFrequencyOfNewmarksMethod) {
  // All vertices at a distance R + u from the centre: M u'' = -K_a A' (A - A_0), A' = 2 A/R. With
  // omega^2 = K_a A'^2/M the motion from rest is u_n = u_0 cos(n phi), 2 (1 - cos phi) =
  // (omega dt)^2/(1 + (omega dt)^2); explicit steps are unstable from omega dt = 2 on.
  constexpr int vertices = 64;
  const ObstacleArray nothing = no_obstacles();
  RunParameters run = bare_parameters(vertices);
  run.drag.terminal_speed = no_drag;
  run.dp.line_tension = 1e-9;
  run.dp.perimeter_stiffness = 0;
  run.dp.area_stiffness = 1e8;  // it is over before gravity has changed the shape
  const Eigen::ArrayXd circle = regular_polygon(vertices, units::rest_area);
  const double radius = circle[0];
  const double omega =
      2 * units::rest_area / radius * std::sqrt(*run.dp.area_stiffness / units::droplet_mass);
  for (const Gravity gravity : {Gravity::vertex, Gravity::area})
    for (const double omega_dt : {0.5, 2.0, 5.0, 20.0}) {
      run.dp.gravity = gravity;
      constexpr double amplitude = 1e-5;  // u_0/R
      const double square = omega_dt * omega_dt;
      const double phi = std::acos(1 - square / (1 + square) / 2);
      SteppedDroplet droplet(run, nothing, state_of((1 + amplitude) * circle));
      for (int n = 1; n <= 40; ++n) {
        droplet.advance(1, omega_dt / omega, true);
        const double area = polygon_shape(droplet.finish().position).area;
        EXPECT_NEAR((std::sqrt(area / units::rest_area) - 1) / amplitude, std::cos(n * phi), 2e-3)
            << omega_dt << ", step " << n;
      }
    }
}

/// A film that falls and contracts, its area mode so stiff that steps of 0.002 need an implicit pressure.
RunParameters film_parameters(Gravity gravity) {
  RunParameters run = bare_parameters(128);
  run.dp.line_tension = 0.1;
  run.dp.area_stiffness = 2000;
  run.dp.gravity = gravity;
  if (gravity == Gravity::area) run.dp.perimeter_spring = PerimeterSpring::along;
  run.dp.perimeter_stiffness = 0.01;
  return run;
}
constexpr double film_time = 0.16;

TEST(ImplicitPressure, MovesADropletAsShortStepsDoToSecondOrder) {
  const ObstacleArray nothing = no_obstacles();
  for (const Gravity gravity : {Gravity::vertex, Gravity::area})
    for (const double relative_drag : {1.0, 3.0}) {
      RunParameters run = film_parameters(gravity);
      run.drag.relative = relative_drag;
      const DropletState initial = state_of(ellipse(128, 4));
      const auto position_after = [&](int steps, bool implicit_pressure) {
        SteppedDroplet film(run, nothing, initial);
        film.advance(steps, film_time / steps, implicit_pressure);
        return Eigen::ArrayXd(film.finish().position);
      };
      const Eigen::ArrayXd exact = position_after(16000, false);
      ASSERT_GT((exact - initial.position).abs().maxCoeff(), 1e-3);
      const double coarse = (position_after(80, true) - exact).abs().maxCoeff();
      const double fine = (position_after(640, true) - exact).abs().maxCoeff();
      EXPECT_LT(fine, 2e-4);
      EXPECT_GT(std::log2(coarse / fine) / 3, 1.7) << coarse << ' ' << fine;
    }
}

TEST(ImplicitPressure, BalancesTheEnergyToSecondOrder) {
  const ObstacleArray nothing = no_obstacles();
  for (const Gravity gravity : {Gravity::vertex, Gravity::area}) {
    const auto imbalance = [&](int steps) {
      const DropletState initial = state_of(ellipse(128, 4));
      Droplet::Work work;
      SteppedDroplet film(film_parameters(gravity), nothing, initial, &work);
      const auto energy_of = [&](const DropletState& state) {
        return units::droplet_mass / 128 / 2 * state.velocity.square().sum() +
               film.forces().energy(state).total() + work.dissipated - work.spreading;
      };
      const double begin = energy_of(initial);
      film.advance(steps, film_time / steps, true);
      return std::abs(energy_of(film.finish()) - begin);
    };
    const double coarse = imbalance(160), fine = imbalance(1280);
    EXPECT_LT(fine, 2e-4);
    EXPECT_GT(std::log2(coarse / fine) / 3, 1.7) << coarse << ' ' << fine;
  }
}

}  // namespace
}  // namespace clog

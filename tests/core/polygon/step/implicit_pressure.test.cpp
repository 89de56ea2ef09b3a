/// Compares steps with an implicit pressure with two references: exact solutions, and short steps with an
/// explicit pressure. dp_step.test.cpp compares each step with the documentation.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/polygon/step/dp_stepper.hpp"
#include "support.hpp"

namespace clog {
namespace {

using namespace test;

TEST(ImplicitPressure, LetsACircleBreatheAtTheFrequencyOfNewmarksMethod) {
  // If all vertices are at the distance R + u from the centre, M u'' = -K_a A' (A - A_0) with A' = 2 A/R. Let
  // omega^2 = K_a A'^2/M and s = (omega dt)^2. Then implicit steps from rest give u_n = u_0 cos(n phi) with
  // cos phi = 1 - s/(2 + 2 s). Explicit steps are unstable if omega dt is 2 or more.
  constexpr int vertices = 64;
  const ObstacleArray nothing = no_obstacles();
  RunParameters run = bare_parameters(vertices);
  run.drag.terminal_speed = no_drag;
  run.dp.line_tension = 1e-9;
  run.dp.perimeter_stiffness = 0;
  run.dp.area_stiffness = 1e8;  // the motion then ends before gravity has changed the shape
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
      DpForces forces(run, nothing);
      DpStepper stepper(run, nothing, forces);
      DropletState droplet = state_of((1 + amplitude) * circle);
      for (int n = 1; n <= 40; ++n) {
        stepper.move(droplet, {{{1, omega_dt / omega, Pressure::implicit}}}, nullptr);
        const double area = polygon_shape(droplet.position).area;
        EXPECT_NEAR((std::sqrt(area / units::rest_area) - 1) / amplitude, std::cos(n * phi), 2e-3)
            << omega_dt << ", step " << n;
      }
    }
}

/// The parameters of a film that falls and contracts. The area mode of the film is so stiff that steps of
/// 0.002 need an implicit pressure.
RunParameters film_parameters(Gravity gravity) {
  RunParameters run = bare_parameters(128);
  run.dp.line_tension = 0.1;
  run.dp.area_stiffness = 2000;
  run.dp.gravity = gravity;
  if (gravity == Gravity::area) run.dp.perimeter_spring = PerimeterSpring::along;
  run.dp.perimeter_stiffness = 0.01;
  return run;
}

/// Moves the film for 0.16 t0.
void move_film(DropletState& film, const RunParameters& run, DpForces& forces, int num_steps,
               Pressure pressure, Droplet::Work* work = nullptr) {
  constexpr int at_once = 16;
  const std::vector<Steps> steps(num_steps / at_once, {at_once, 0.16 / num_steps, pressure});
  DpStepper(run, no_obstacles(), forces).move(film, steps, work);
}

TEST(ImplicitPressure, MovesADropletAsShortStepsDoToSecondOrder) {
  const ObstacleArray nothing = no_obstacles();
  for (const Gravity gravity : {Gravity::vertex, Gravity::area})
    for (const double relative_drag : {1.0, 3.0}) {
      RunParameters run = film_parameters(gravity);
      run.drag.relative = relative_drag;
      const DropletState initial = state_of(ellipse(128, 4));
      const auto position_after = [&](int steps, Pressure pressure) {
        DpForces forces(run, nothing);
        DropletState film = initial;
        move_film(film, run, forces, steps, pressure);
        return film.position;
      };
      const Eigen::ArrayXd exact = position_after(16000, Pressure::present);
      ASSERT_GT((exact - initial.position).abs().maxCoeff(), 1e-3);
      const double coarse = (position_after(80, Pressure::implicit) - exact).abs().maxCoeff();
      const double fine = (position_after(640, Pressure::implicit) - exact).abs().maxCoeff();
      EXPECT_LT(fine, 2e-4);
      EXPECT_GT(std::log2(coarse / fine) / 3, 1.7) << coarse << ' ' << fine;
    }
}

TEST(ImplicitPressure, BalancesTheEnergyToSecondOrder) {
  const ObstacleArray nothing = no_obstacles();
  for (const Gravity gravity : {Gravity::vertex, Gravity::area}) {
    const auto imbalance = [&](int steps) {
      const RunParameters run = film_parameters(gravity);
      DpForces forces(run, nothing);
      DropletState film = state_of(ellipse(128, 4));
      Droplet::Work work;
      const auto energy = [&] {
        return units::droplet_mass / 128 / 2 * film.velocity.square().sum() + forces.energy(film).total() +
               work.dissipated - work.spreading;
      };
      forces.update_contacts(film, {});
      const double begin = energy();
      move_film(film, run, forces, steps, Pressure::implicit, &work);
      return std::abs(energy() - begin);
    };
    const double coarse = imbalance(160), fine = imbalance(1280);
    EXPECT_LT(fine, 2e-4);
    EXPECT_GT(std::log2(coarse / fine) / 3, 1.7) << coarse << ' ' << fine;
  }
}

}  // namespace
}  // namespace clog

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <tuple>

#include "../core/support.hpp"
#include "clog/core/tools/units.hpp"
#include "ending.hpp"
#include "findings.hpp"

namespace clog::soundness {
namespace {

constexpr int num_vertices = 256;
const double vertex_diameter = units::regular_edge_length(128);  // the unit of depths, also for finer meshes

DropletState circle() { return test::state_of(regular_polygon(num_vertices, units::rest_area)); }

TEST(Findings, OfACircleAreThoseOfACircle) {
  const Findings findings = look_at(circle(), test::no_obstacles());
  EXPECT_TRUE(is_sound(findings));
  EXPECT_EQ(findings.overlap, 0);
  EXPECT_NEAR(findings.area_error, 0, 1e-12);
  EXPECT_NEAR(findings.edge_ratio, 1, 1e-12);
  EXPECT_NEAR(findings.perimeter, 1, 1e-4);
  EXPECT_NEAR(findings.shape, 1, 1e-3);
}

/// A circle below an edge of the droplet. @param distance  of the circle's surface from the edge [vertex
/// diameters]
Findings with_obstacle_at(double distance) {
  const DropletState state = circle();
  const double radius = 0.15;
  const double lowest_edge = 0.5 * (state.y()[191] + state.y()[192]);
  const Obstacle obstacle{0.5 * (state.x()[191] + state.x()[192]),
                          lowest_edge - radius - distance * vertex_diameter, radius};
  return look_at(state, ObstacleArray(20, {obstacle}));
}

TEST(Findings, SeeHowDeepAnObstacleReaches) {
  EXPECT_EQ(with_obstacle_at(0.1).overlap, 0);
  EXPECT_NEAR(with_obstacle_at(-0.1).overlap, 0.1, 1e-2);
  EXPECT_TRUE(is_sound(with_obstacle_at(-0.2)));
  EXPECT_FALSE(is_sound(with_obstacle_at(-0.3)));
  EXPECT_NEAR(with_obstacle_at(-1).overlap, 1, 1e-2);
}

TEST(Findings, SeeAnObstacleInsideThatTouchesNothing) {
  const Findings findings = look_at(circle(), ObstacleArray(20, {{0.1, 0, 0.15}}));
  EXPECT_EQ(findings.enclosed, 1);
  EXPECT_EQ(findings.overlap, 0);
  EXPECT_FALSE(is_sound(findings));
}

TEST(Findings, SeeAFoldedContourAndAWrongArea) {
  DropletState folded = circle();
  std::swap(folded.x()[10], folded.x()[12]);
  std::swap(folded.y()[10], folded.y()[12]);
  EXPECT_GT(look_at(folded, test::no_obstacles()).crossings, 0);
  EXPECT_FALSE(is_sound(look_at(folded, test::no_obstacles())));

  DropletState swollen = circle();
  swollen.position *= std::sqrt(1.06);
  EXPECT_NEAR(look_at(swollen, test::no_obstacles()).area_error, 0.06, 1e-9);
  EXPECT_FALSE(is_sound(look_at(swollen, test::no_obstacles())));
}

/// The tail of a droplet with vertices that move by `displace(state, time)`. Its E_k/E_t is `energy(time)`.
template <class Displace, class Energy>
Tail tail_of(Displace displace, Energy energy) {
  constexpr double interval = 0.064;
  constexpr int energies_per_place = 32, places = 50;
  TailRecorder recorder(0.03);
  const DropletState start = circle();
  for (int place = 0; place < places; ++place) {
    DropletState state = start;
    displace(state, place * energies_per_place * interval);
    state.recentre();
    recorder.add_place(state);
    for (int i = 0; i < energies_per_place; ++i)
      recorder.add_energy(energy((place * energies_per_place + i) * interval), interval);
  }
  return recorder.tail().value();
}

TEST(Ending, IsMovingWhenTheCentreTravelsAcrossFrames) {
  const Tail tail =
      tail_of([](DropletState& state, double time) { state.x() += 0.03 * time; }, [](double) { return 1.0; });
  EXPECT_EQ(tail.ending(), Ending::moving);
  // The last place was added before the last interval, so the speed is not exact.
  EXPECT_NEAR(tail.mean_speed, 1, 0.05);
  EXPECT_NEAR(tail.coherence, 1, 1e-6);
}

/// Moves neighbouring vertices in opposite directions at 1e-3 V_t.
void creep(DropletState& state, double time) {
  for (Eigen::Index i = 0; i < state.size(); ++i) state.y()[i] += 0.03e-3 * time * (i % 2 == 0 ? 1 : -1);
}

TEST(Ending, IsSteadyOrDecayingWhenTheInterfaceCreeps) {
  const Tail steady = tail_of(creep, [](double) { return 1e-6; });
  EXPECT_EQ(steady.ending(), Ending::steady);
  EXPECT_NEAR(steady.coherence, 1, 1e-6);
  EXPECT_NEAR(steady.level, -6, 1e-9);

  const Tail decaying = tail_of(creep, [](double time) { return 1e-6 * std::exp(-time / 40); });
  EXPECT_EQ(decaying.ending(), Ending::decaying);
  const Tail growing = tail_of(creep, [](double time) { return 1e-6 * std::exp(time / 40); });
  EXPECT_EQ(growing.ending(), Ending::steady);
  EXPECT_LT(growing.fall, -0.5);
}

TEST(Ending, IsChatteringWhenVerticesShakeAboutTheirPlaces) {
  std::mt19937 engine(1);
  std::normal_distribution<double> scatter(0, 1);
  const auto shake = [&](DropletState& state, double) {
    for (double& value : state.position) value += 1e-6 * scatter(engine);
  };
  // The energy corresponds to a speed of 1e-2 V_t. A vertex with this speed would move by 6e-4 between two
  // places.
  const Tail tail = tail_of(shake, [&](double) { return 1e-4 * std::pow(10, scatter(engine)); });
  EXPECT_EQ(tail.ending(), Ending::chattering);
  EXPECT_GT(tail.band, 1);
}

TEST(Ending, IsNotToldFromAFewSamples) {
  TailRecorder recorder(0.03);
  recorder.add_place(circle());
  recorder.add_energy(1, 0.064);
  EXPECT_FALSE(recorder.tail());
}

}  // namespace
}  // namespace clog::soundness

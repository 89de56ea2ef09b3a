#include "clog/core/polygon/wetting/contact_line.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <vector>

#include "clog/core/model/model.hpp"
#include "clog/core/polygon/forces/dp_forces.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "polygon/forces/reference_forces.hpp"
#include "support.hpp"

namespace clog {
namespace {

using namespace test;
using std::numbers::pi;

double cosine(double degrees) { return std::cos(degrees * pi / 180); }

TEST(ContactLine, YoungsAngleIsThatOfTheWallsTension) {
  DpParameters dp;
  EXPECT_EQ(young_angle(dp), 180);
  EXPECT_FALSE(has_hysteresis(dp));
  dp.wall_tension = 0.5;
  EXPECT_NEAR(young_angle(dp), 120, 1e-12);
  dp.advancing_angle = 130;
  EXPECT_TRUE(has_hysteresis(dp));
}

TEST(ContactLine, ForceIsTheGradientOfTheEnergyWhileTheAnchorsRest) {
  RunParameters run = bare_parameters();
  run.dp.receding_angle = 90;
  const double reach = 0.5 + *run.dp.contact_range;
  const Wedge flank{.tip = {0.1, -reach * 0.96}, .axis = {0.6, -0.8}, .half_angle = 0.7, .radius = 0.05};
  const ObstacleArray walls(20, {{reach + 0.13, 0.05, 0.15}}, {flank});
  DropletState state = state_of(regular_polygon(64, units::rest_area));
  ReferenceForces forces(run, walls);
  forces.update_contacts(state, {.absolute = 0.01, .relative = 0.01});
  WallTouches touches(run, walls);
  forces.let_walls_yield(state, touches, forces.walls().items(), Purpose::motion);
  ASSERT_EQ(state.anchors.size(), 4);  // there are two arcs
  state.position = shaken(state.position, 0.001);
  EXPECT_GT(forces.energy(state).anchors, 5e-6);
  EXPECT_LT(force_error(forces, state), 1e-6);
}

TEST(ContactLine, AnEndsGradientIsBounded) {
  // The gradient has a bound, which the limit of the time step uses. The bound must hold for any wetted wall.
  const ObstacleArray walls(20, {{0.63, 0.05, 0.15}});
  for (unsigned seed = 1; seed <= 200; ++seed) {
    RunParameters run = bare_parameters();
    run.dp.receding_angle = 90;
    DropletState state = state_of(shaken(regular_polygon(64, units::rest_area), 0.004, seed));
    WallContacts near(walls, *run.dp.contact_range + wetting_width * units::regular_edge_length(64),
                      WallContacts::Keep::touched_by_vertex);
    near.update(state, {});
    ContactLine::Ends ends;
    ContactLine(run, {}).find_ends(VertexPlaces(state), state.frame, near.items(), ends);
    for (const ContactLine::End& end : ends.all()) {
      double square = 0;
      for (const auto& [vertex, gradient] : ends.gradients(end)) square += gradient.square().sum();
      EXPECT_LT(square, pinning_gradient2);
    }
  }
}

/// A drop that is moved from its place of release onto walls.
DropletRun drop_on(RunParameters run, const std::vector<Obstacle>& circles, const std::vector<Wedge>& wedges,
                   double max_time) {
  run.drag.terminal_speed = 0.1;
  run.max_time = max_time;
  run = onto_wall(run);
  DropletState state = state_of(model_of(run).free_shape(run));
  state.x() += 10;
  state.y() += 10;
  return {run, std::make_shared<ObstacleArray>(20, circles, wedges), std::move(state), 5.0};
}

struct Angles {
  double wall_tension, receding, advancing;
};
RunParameters sticky(const Angles& angles, int vertices, double line_tension = 1) {
  RunParameters run;
  run.dp.vertices = vertices;
  run.dp.line_tension = line_tension;
  run.dp.wall_tension = angles.wall_tension;
  run.dp.receding_angle = angles.receding;
  run.dp.advancing_angle = angles.advancing;
  return run;
}

class OnAnIncline : public testing::TestWithParam<Angles> {
 protected:
  /// A drop on an inclined wall. The drop's weight along the wall is `share` times the weight that Furmidge's
  /// equation allows.
  static DropletRun drop(double share, int vertices) {
    const Angles angles = GetParam();
    const double along = share * (cosine(angles.receding) - cosine(angles.advancing));
    slope_ = std::asin(along / units::rest_area);
    const Eigen::Array2d into{std::cos(slope_), -std::sin(slope_)};
    const Wedge wall{.tip = Eigen::Array2d(10, 10) + 0.5 * into, .axis = into};
    return drop_on(sticky(angles, vertices), {}, {wall}, 60);
  }
  /// The distance down the wall.
  static double way(const DropletRun& run) {
    return run.displacement()[0] * std::sin(slope_) + run.displacement()[1] * std::cos(slope_);
  }

 private:
  static inline double slope_ = 0;
};
INSTANTIATE_TEST_SUITE_P(Angles, OnAnIncline, testing::Values(Angles{1, 120, 180}, Angles{0.5, 100, 140}));

TEST_P(OnAnIncline, ADropSticksBelowWhatFurmidgeAllowsAndSlidesAbove) {
  // Furmidge's equation is a sin(slope) = Gamma (cos receding - cos advancing). The wall holds a part of the
  // weight of a sliding drop, and the drag balances the rest.
  const double allowed = cosine(GetParam().receding) - cosine(GetParam().advancing);
  for (const int vertices : {64, 128}) {
    DropletRun held = drop(0.98, vertices);
    while (!held.advance(100)) {
    }
    EXPECT_EQ(held.result().status, RunStatus::clogged) << vertices;
    EXPECT_EQ(held.result().clogged_by, FoundBy::certified) << vertices;

    constexpr double share = 1.02;
    DropletRun sliding = drop(share, vertices);
    while (sliding.time() < 30) ASSERT_FALSE(sliding.advance(1));
    const double time = sliding.time(), place = way(sliding);
    while (!sliding.advance(100)) {
    }
    EXPECT_EQ(sliding.result().status, RunStatus::flowing);
    const double speed = (way(sliding) - place) / (sliding.time() - time);
    const double borne = share * allowed - units::droplet_mass / 0.1 * speed;
    std::printf("%d vertices: the walls bear %+.4f more\n", vertices, borne / allowed - 1);
    EXPECT_NEAR(borne / allowed, 1, vertices == 64 ? 0.005 : 0.0025);
  }
}

struct Disc {
  const char* name;
  double radius, line_tension;
  Angles angles;
  double tolerance[2];  ///< tolerance of the torque with 64 and with 128 vertices
};

class OnADisc : public testing::TestWithParam<Disc> {
 protected:
  static constexpr double aside = 0.1;  // offset from the disc's centre at which the drop starts

  static DropletRun drop(int vertices) {
    const Disc& disc = GetParam();
    return drop_on(sticky(disc.angles, vertices, disc.line_tension),
                   {{10.5 + disc.radius, 10 - aside, disc.radius}}, {}, 150);
  }
};
INSTANTIATE_TEST_SUITE_P(Sizes, OnADisc,
                         testing::Values(Disc{"large", 3, 0.3, {1, 60, 180}, {0.01, 0.005}},
                                         Disc{"small", 0.5, 1, {0.5, 30, 150}, {0.03, 0.01}}),
                         [](const auto& test) { return std::string(test.param.name); });

/// Apart from the weight, only the forces f_0 and f_1 along the wall, on the two ends of the drop, have a
/// torque about the disc's centre. The balance is M g y = R (f_0 - f_1), where y is the offset of the drop's
/// centroid from the disc's centre. In this way a disc holds two lobes of different weight.
TEST_P(OnADisc, CarriesTheTorqueOfADropsWeight) {
  const Disc& disc = GetParam();
  double error[2];
  for (const int vertices : {64, 128}) {
    DropletRun run = drop(vertices);
    while (!run.advance(100)) {
    }
    const RunResult result = run.result();
    ASSERT_EQ(result.clogged_by, FoundBy::certified);
    const double beside = aside + result.lateral;
    const auto rest =
        model_of(run.parameters()).equilibrium(run.parameters(), run.obstacles(), run.droplet().state());
    double pull = 0;
    for (const WallAnchor& anchor : rest.value().anchors) {
      const double stiffness = pinning_stiffness * disc.line_tension / units::regular_edge_length(vertices);
      pull += (anchor.holder == 0 ? -1 : 1) * stiffness * anchor.slip;
    }
    error[vertices == 128] = disc.radius * pull / (units::droplet_mass * beside) - 1;
    std::printf("%d vertices, beside by %.4f: the ends carry %+.5f more\n", vertices, beside,
                error[vertices == 128]);
  }
  EXPECT_LT(std::abs(error[0]), disc.tolerance[0]);
  EXPECT_LT(std::abs(error[1]), disc.tolerance[1]);
  EXPECT_LT(std::abs(error[1]), std::abs(error[0]) / 2);
}

TEST(ContactLine, LetsADropGoWhoseWeightTurnsItMoreThanTheEndsBear) {
  // The ends can hold the weight up to an offset of y = R Gamma h/(M g) = 0.15 from the disc's centre, with h
  // = cos receding - cos advancing.
  DropletRun lost = drop_on(sticky({1, 150, 180}, 64, 0.3), {{13.5, 9.9, 3}}, {}, 150);
  while (!lost.advance(100)) {
  }
  EXPECT_NE(lost.result().status, RunStatus::clogged);
}

}  // namespace
}  // namespace clog

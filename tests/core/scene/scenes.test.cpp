#include "clog/core/droplet/release.hpp"
#include "clog/core/model/model.hpp"
#include "clog/core/run/droplet_run.hpp"

#include <gtest/gtest.h>

#include <array>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <numbers>

#include "clog/core/droplet/shape.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/units.hpp"
#include "support.hpp"

namespace clog {
namespace {

using std::numbers::pi;

RunParameters parameters(double line_tension, int vertices = 256) {
  RunParameters run;
  run.dp.line_tension = line_tension;
  run.dp.vertices = vertices;
  run.max_time = 3000;
  run.clog_energy = 1e-12;
  return run;
}

DropletRun at_rest_on_a_wall(const RunParameters& run) {
  DropletRun droplet(test::onto_wall(run));
  while (!droplet.advance(100)) continue;
  EXPECT_EQ(droplet.result().status, RunStatus::clogged);
  return droplet;
}

/// A two-dimensional drop on a wall. A Runge-Kutta method integrates the Young-Laplace equation
/// Gamma dphi/ds = Gamma kappa_0 + z, in which z is the depth below the apex, and phi is the angle of the
/// slope. At the apex phi is 0, and at the wall phi is the contact angle. On a wall that is not wetted the
/// contact angle is pi.
struct SessileDrop {
  double height = 0, area = 0, half_width = 0, depth_of_centroid = 0;
};
SessileDrop sessile_drop(double line_tension, double apex_curvature, double contact_angle) {
  using State = std::array<double, 5>;  // phi, x, z, area, moment of depth
  const auto slope = [&](const State& y) {
    const double dz = std::sin(y[0]);
    return State{apex_curvature + y[2] / line_tension, std::cos(y[0]), dz, 2 * y[1] * dz,
                 2 * y[1] * y[2] * dz};
  };
  const double step = 1e-4;
  State y{};
  SessileDrop drop;
  while (y[0] < contact_angle) {
    const auto moved = [&](const State& k, double h) {
      State z = y;
      for (int i = 0; i < 5; ++i) z[i] += h * k[i];
      return z;
    };
    const State k1 = slope(y), k2 = slope(moved(k1, step / 2)), k3 = slope(moved(k2, step / 2)),
                k4 = slope(moved(k3, step));
    for (int i = 0; i < 5; ++i) y[i] += step / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    drop.half_width = std::max(drop.half_width, y[1]);
  }
  drop.height = y[2];
  drop.area = y[3];
  drop.depth_of_centroid = y[4] / y[3];
  return drop;
}
SessileDrop sessile_drop_of_rest_area(double line_tension, double contact_angle = pi) {
  const auto excess = [&](double log_curvature) {
    return sessile_drop(line_tension, std::exp(log_curvature), contact_angle).area - units::rest_area;
  };
  const auto [low, high] = boost::math::tools::bisect(
      excess, std::log(1e-4), std::log(2.5), [](double a, double b) { return std::abs(a - b) < 1e-9; });
  return sessile_drop(line_tension, std::exp((low + high) / 2), contact_angle);
}

class OnAWall : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Tensions, OnAWall, testing::Values(0.05, 0.2, 1.0));

TEST_P(OnAWall, ADropletHasTheShapeOfYoungAndLaplace) {
  const DropletRun run = at_rest_on_a_wall(parameters(GetParam()));
  const Eigen::ArrayXd& position = run.droplet().state().position;
  const auto x = position.head(256);
  const auto y = position.tail(256);
  const SessileDrop exact = sessile_drop_of_rest_area(GetParam());
  EXPECT_NEAR(x.maxCoeff() - x.minCoeff(), exact.height, 0.003);
  EXPECT_NEAR((y.maxCoeff() - y.minCoeff()) / 2, exact.half_width, 0.003);
  const double centroid = area_centroid(position)[0];
  EXPECT_NEAR(centroid - x.minCoeff(), exact.depth_of_centroid, 0.003);
  // The sag is the distance by which the centroid has sunk. The centroid of a circle is half a diameter above
  // the wall.
  const double sag = run.displacement_of(area_centroid(position))[0];
  EXPECT_NEAR(sag, 0.5 - (exact.height - exact.depth_of_centroid), 0.003);
}

TEST(OnAWall, TheProfileIsThatOfYoungAndLaplaceFromTopToBottom) {
  // With the depth z, the curvature of the interface grows by z/Gamma. The integral of this law over z is
  // Gamma (1 - cos phi) = Gamma kappa_0 z + z^2/2, where phi is the angle of the slope.
  const double line_tension = 0.1;
  const DropletRun run = at_rest_on_a_wall(parameters(line_tension, 512));
  const Eigen::ArrayXd& position = run.droplet().state().position;
  const SessileDrop exact = sessile_drop_of_rest_area(line_tension);
  const double kappa_0 = (2 - exact.height * exact.height / (2 * line_tension)) / exact.height;
  const double apex = position.head(512).minCoeff();
  double worst = 0;
  for (int i = 0; i < 512; ++i) {
    const int next = (i + 1) % 512;
    const double z = (position[i] + position[next]) / 2 - apex;
    if (z > 0.98 * exact.height) continue;  // this part rests on the wall
    const double ex = position[next] - position[i];
    const double ey = position[512 + next] - position[512 + i];
    const double cosine = std::abs(ey) / std::hypot(ex, ey);
    const double expected = std::abs(1 - kappa_0 * z - z * z / (2 * line_tension));
    worst = std::max(worst, std::abs(cosine - expected));
  }
  EXPECT_LT(worst, 0.02);
}

TEST(OnAWall, ASoftDiskSagsAsItsSpringSays) {
  // The weight M g equals (4 E_w/sigma^2) times the sag, so the sag is pi/(16 E_w).
  for (const double stiffness : {0.5, 1.0, 10.0}) {
    RunParameters run = parameters(1);
    run.model = Model::sp;
    run.dp = {};
    run.wall_stiffness = stiffness;
    EXPECT_NEAR(at_rest_on_a_wall(run).result().distance, pi / (16 * stiffness), 1e-6);
  }
}

TEST(OnAWall, SagHasItsStiffAndItsSoftLimit) {
  // The thickness of a puddle is 2 sqrt(Gamma). A stiff droplet does not sag.
  const DropletRun soft = at_rest_on_a_wall(parameters(0.005));
  const auto x = soft.droplet().state().x();
  EXPECT_NEAR((x.maxCoeff() - x.minCoeff()) / (2 * std::sqrt(0.005)), 1, 0.05);
  const DropletRun stiff = at_rest_on_a_wall(parameters(10));
  EXPECT_LT(stiff.displacement_of(area_centroid(stiff.droplet().state().position))[0], 0.015);
}

/// The length of the longest edge divided by that of the shortest.
double edge_ratio(const DropletState& state) {
  double longest = 0, shortest = 1e9;
  for (Eigen::Index i = 0, j = state.size() - 1; i < state.size(); j = i++) {
    const double length = std::hypot(state.x()[i] - state.x()[j], state.y()[i] - state.y()[j]);
    longest = std::max(longest, length);
    shortest = std::min(shortest, length);
  }
  return longest / shortest;
}

TEST(OnAWall, VerticesStayEvenlySpreadWhereThoseOfTheLiteralModelSlideDown) {
  RunParameters run = parameters(1.0);
  run.max_time = 60;
  const auto ratio_after = [](const RunParameters& parameters) {
    DropletRun droplet(test::onto_wall(parameters));
    while (!droplet.advance(100)) continue;
    return edge_ratio(droplet.droplet().state());
  };
  EXPECT_LT(ratio_after(run), 1.05);
  run.dp.perimeter_spring = PerimeterSpring::rest;
  run.dp.gravity = Gravity::vertex;
  run.dp.self_contact = SelfContact::off;
  run.dp.wall_contact = WallContact::vertex;
  EXPECT_GT(ratio_after(run), 5);
}

/// The height and half the width of a droplet on a wetted wall.
std::pair<double, double> size_on_a_wetted_wall(RunParameters run, double wall_tension) {
  run.dp.wall_tension = wall_tension;
  run.time_step = 1e-3;
  run.drag.terminal_speed = 0.1;
  run.max_time = 100;
  run.clog_energy = 1e-9;
  const DropletRun droplet = at_rest_on_a_wall(run);
  const auto x = droplet.droplet().state().x();
  const auto y = droplet.droplet().state().y();
  return {x.maxCoeff() - x.minCoeff(), (y.maxCoeff() - y.minCoeff()) / 2};
}

TEST(OnAWall, AWettedWallIsMetAtYoungsAngle) {
  // The contact angle follows cos theta = -wall-tension. The tension changes within three vertex diameters of
  // the wall, which are 0.07 here.
  for (const double line_tension : {5.0, 0.3})
    for (const double wall_tension : {0.7, 0.5, 0.3, 0.15}) {
      const SessileDrop exact = sessile_drop_of_rest_area(line_tension, std::acos(-wall_tension));
      const auto [height, half_width] = size_on_a_wetted_wall(parameters(line_tension, 128), wall_tension);
      EXPECT_NEAR(height / exact.height, 1, 0.01) << line_tension << ", " << wall_tension;
      EXPECT_NEAR(half_width / exact.half_width, 1, 0.03) << line_tension << ", " << wall_tension;
    }
}

TEST(OnAWall, TheShapeOnAWettedWallHangsNeitherOnTheSpringsNorOnTheVertices) {
  RunParameters run = parameters(5, 64);
  run.dp.perimeter_stiffness = 0.1;
  const auto [height, half_width] = size_on_a_wetted_wall(run, 0.3);
  run.dp.perimeter_stiffness = 0.3;
  EXPECT_NEAR(size_on_a_wetted_wall(run, 0.3).first / height, 1, 0.01);
  run.dp.vertices = 256;
  EXPECT_NEAR(size_on_a_wetted_wall(run, 0.3).first / height, 1, 0.01);
}

/// The shape parameter of a droplet in an orifice with rounded tips. The outline consists of two equal arcs,
/// the caps, one on each side of the orifice, and of the arcs of the tips between the caps. All quarters are
/// equal. If h is the distance of a tip's centre from the axis, and c is the distance of a cap's centre from
/// the orifice, the radius of the cap is R = sqrt(c^2 + h^2) - tip_radius. The area of a quarter is half of
/// R^2 cap + c h - tip_radius^2 tip, where `cap` and `tip` are the angles of the arcs.
double shape_of_two_caps(double orifice, double tip_radius) {
  const double h = orifice / 2 + tip_radius;
  const auto shape = [&](double c) {
    const double radius = std::hypot(c, h) - tip_radius, cap = pi - std::atan2(h, c), tip = std::atan2(c, h);
    const double quarter = (radius * radius * cap + c * h - tip_radius * tip_radius * tip) / 2;
    return PolygonShape{.area = 4 * quarter, .perimeter = 4 * (radius * cap + tip_radius * tip)};
  };
  const auto [low, high] =
      boost::math::tools::bisect([&](double c) { return shape(c).area - units::rest_area; }, 0.0, 1.0,
                                 [](double a, double b) { return std::abs(a - b) < 1e-12; });
  return shape((low + high) / 2).shape_parameter();
}

constexpr double tip_radius = 0.03;

double largest_shape_parameter(RunParameters run, double orifice) {
  run.drag.terminal_speed = 0.02;
  DropletRun droplet(
      test::in_channel(run, {.orifice = orifice, .tip_radius = tip_radius, .start = -0.8, .end = 0.6}));
  double largest = 0;
  while (!droplet.advance(1)) largest = std::max(largest, droplet.droplet().shape().shape_parameter());
  EXPECT_EQ(droplet.result().status, RunStatus::passed);
  return largest;
}

TEST(InAChannel, TwoCapsAreOneCircleOnAWideChordAndTwoOnANarrowOne) {
  EXPECT_NEAR(shape_of_two_caps(1 - 1e-9, 0), 1, 1e-6);
  EXPECT_NEAR(shape_of_two_caps(0.1, 0), 2, 0.2);
  // Computed by hand with R = 0.39773 and theta = 2.06544.
  EXPECT_NEAR(shape_of_two_caps(0.7, 0), 1.09366, 1e-5);
  EXPECT_GT(shape_of_two_caps(0.7, 0.03), shape_of_two_caps(0.7, 0)) << "the neck is longer";
}

TEST(InAChannel, ADropletThatPassesSlowlyIsTwoCapsOnTheTips) {
  for (const auto& [orifice, line_tension] : {std::pair{0.7, 0.42}, {0.7, 1.0}, {0.9, 1.7}})
    EXPECT_NEAR(largest_shape_parameter(parameters(line_tension, 128), orifice),
                shape_of_two_caps(orifice, tip_radius), 0.001)
        << orifice << ", " << line_tension;
}

TEST(InAChannel, TheShapeConvergesInSecondOrderAsVerticesGrowMany) {
  const double exact = shape_of_two_caps(0.7, tip_radius);
  const double coarse = std::abs(largest_shape_parameter(parameters(0.42, 64), 0.7) - exact);
  const double fine = std::abs(largest_shape_parameter(parameters(0.42, 128), 0.7) - exact);
  EXPECT_LT(coarse, 0.005);
  EXPECT_LT(fine, coarse / 3);
}

TEST(InAChannel, TheLiteralContactLetsTheTipSinkIn) {
  RunParameters run = parameters(1.0);
  run.dp.perimeter_spring = PerimeterSpring::rest;
  run.dp.gravity = Gravity::vertex;
  run.dp.wall_contact = WallContact::vertex;
  run.dp.contact_range.reset();
  const double narrowed = 0.7 - units::regular_edge_length(256);
  EXPECT_LT(largest_shape_parameter(run, 0.7), shape_of_two_caps(narrowed, tip_radius) - 0.005);
}

/// The largest Gamma at which the weight can push a droplet through a chord. The droplet consists of two caps
/// of circles. This Gamma is M g divided by the largest dP/dh, where P is the perimeter and h is the distance
/// of the centroid from the chord. All pairs of caps are considered that have the droplet's area and fit
/// between flanks of 45 degrees.
double largest_line_tension_that_passes(double chord) {
  struct Cap {
    double area, length, moment;  // moment is the area times the centroid's distance from the chord
  };
  const auto cap = [chord](double theta) {
    const double radius = chord / (2 * std::sin(theta));
    const double area = radius * radius * (theta - std::sin(theta) * std::cos(theta));
    return Cap{area, 2 * radius * theta,
               2.0 / 3 * std::pow(radius * std::sin(theta), 3) - radius * std::cos(theta) * area};
  };
  const double widest = 3 * pi / 4;
  const auto pair_of_caps = [&](double behind) {
    const Cap back = cap(behind);
    const auto missing = [&](double theta) { return cap(theta).area + back.area - units::rest_area; };
    const auto [low, high] = boost::math::tools::bisect(
        missing, 1e-4, widest, [](double a, double b) { return std::abs(a - b) < 1e-12; });
    const Cap front = cap((low + high) / 2);
    return std::pair((front.moment - back.moment) / units::rest_area, front.length + back.length);
  };
  double steepest = 0;
  for (double theta = widest; theta > pi / 2; theta -= 1e-3) {
    if (cap(theta).area >= units::rest_area) continue;
    const auto [h, perimeter] = pair_of_caps(theta);
    const auto [next_h, next_perimeter] = pair_of_caps(theta - 1e-4);
    steepest = std::max(steepest, (next_perimeter - perimeter) / (next_h - h));
  }
  return units::droplet_mass * units::gravity / steepest;
}

TEST(InAChannel, ADropletPassesUpToTheLineTensionThatStaticsAllows) {
  const double limit = largest_line_tension_that_passes(0.7);
  EXPECT_NEAR(limit, 1.19, 0.005);
  for (const double part : {0.95, 1.1}) {
    RunParameters run = parameters(part * limit);
    run.drag.terminal_speed = 0.1;
    run.max_time = 150;
    DropletRun droplet(test::in_channel(run, {.orifice = 0.7, .start = -0.8, .end = 0.6}));
    while (!droplet.advance(100)) continue;
    EXPECT_EQ(droplet.result().status == RunStatus::passed, part < 1) << part;
  }
}

TEST(InAChannel, ParallelWallsSlowACircleByTheMeanDragOfItsVertices) {
  // A circle midway between the walls has the drag zeta = b_inf (1 + b_0/b_inf mean of d_i^-alpha). Here d_i
  // is the distance of vertex i from the nearer wall.
  RunParameters run = parameters(1, 128);
  run.drag.near_wall = 0.07;
  run.drag.terminal_speed = 0.03;
  // Without springs to the rest length, the vertices would slide along the interface away from the walls.
  run.dp.perimeter_spring = PerimeterSpring::rest;
  run.dp.gravity = Gravity::vertex;
  run.dp.perimeter_stiffness = 1;
  for (const double distance : {0.1, 1.0}) {
    DropletRun droplet(
        test::in_channel(run, {.orifice = 1 + 2 * distance, .wedge_angle = 0, .start = 0, .end = 0.6}));
    while (!droplet.advance(100)) continue;
    double mean = 0;
    for (int i = 0; i < 128; ++i)
      mean += std::pow(distance + 0.5 * (1 - std::abs(std::sin(2 * pi * i / 128))),
                       -run.drag.near_wall_exponent) /
              128;
    const double speed = droplet.droplet().centre_velocity()[0] / run.drag.terminal_speed;
    EXPECT_NEAR(speed * (1 + run.drag.near_wall * mean), 1, 0.01) << distance;
  }
}

TEST(InAChannel, RefusesWhatCannotBe) {
  const RunParameters run = parameters(1);
  for (const ChannelParameters& channel :
       {ChannelParameters{.orifice = 0.02}, ChannelParameters{.orifice = std::nan("")},
        ChannelParameters{.orifice = 0.99, .wedge_angle = 0}, ChannelParameters{.wedge_angle = 3},
        ChannelParameters{.tip_radius = -1}, ChannelParameters{.start = -0.2}, ChannelParameters{.start = 1},
        ChannelParameters{.end = -11}})
    EXPECT_THROW(test::in_channel(run, channel), Error);
}

TEST(FreeDroplet, IsInEquilibrium) {
  const RunParameters run = resolve(parameters(10));
  const double area = polygon_shape(model_of(run).free_shape(run)).area;
  // The pressure K_a (a_0 - a) equals Gamma/R.
  EXPECT_NEAR(*run.dp.area_stiffness * (units::rest_area - area), 10 / std::sqrt(area / pi), 1e-2);
}

}  // namespace
}  // namespace clog

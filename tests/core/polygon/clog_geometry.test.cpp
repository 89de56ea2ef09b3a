#include "clog/core/polygon/clog_geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "clog/core/droplet/shape.hpp"
#include "support.hpp"

namespace clog {
namespace {

constexpr double range = 0.006;
constexpr double radius = 0.15;  // of the obstacles

struct Scene {
  Eigen::ArrayXd position;
  std::vector<Obstacle> obstacles;
  std::vector<Wedge> walls = {};

  ClogGeometry geometry() const { return clog_geometry(position, {obstacles, walls}, range); }
};

/// An obstacle that touches a disc of diameter 1 around the origin. @param angle  direction of the obstacle
/// from the origin [degrees]
Obstacle against_the_disc(double angle) {
  const double distance = 0.5 + radius + 0.5 * range;
  const double t = angle * std::numbers::pi / 180;
  return {distance * std::cos(t), distance * std::sin(t), radius};
}

Scene disc_on(const std::vector<double>& angles) {
  Scene scene{regular_polygon(256, units::rest_area), {}};
  for (const double angle : angles) scene.obstacles.push_back(against_the_disc(angle));
  return scene;
}

/// A closed contour through these corners, with edges of length 0.01 or nearly so.
Eigen::ArrayXd with_short_edges(const std::vector<Eigen::Array2d>& corners) {
  std::vector<Eigen::Array2d> points;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Array2d way = corners[(i + 1) % corners.size()] - corners[i];
    const int pieces = std::max(1, static_cast<int>(std::lround(way.matrix().norm() / 0.01)));
    for (int k = 0; k < pieces; ++k) points.emplace_back(corners[i] + way * k / pieces);
  }
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::ArrayXd position(2 * n);
  for (Eigen::Index i = 0; i < n; ++i) position[i] = points[i][0], position[n + i] = points[i][1];
  return position;
}

constexpr double inner = radius + 0.5 * range;
constexpr double outer = 0.45;

/// A droplet that hangs over an obstacle at the origin. The droplet consists of a half ring upstream of the
/// obstacle, and of a lobe on each side. The arguments are the lengths of the lobes.
Scene horseshoe(double right_lobe, double left_lobe) {
  std::vector<Eigen::Array2d> corners;
  const auto add_half_circle = [&](double r, double from, double to) {
    for (int k = 0; k <= 60; ++k) {
      const double t = (from + (to - from) * k / 60) * std::numbers::pi / 180;
      corners.emplace_back(r * std::cos(t), r * std::sin(t));
    }
  };
  corners.emplace_back(right_lobe, inner);
  corners.emplace_back(right_lobe, outer);
  add_half_circle(outer, 90, 270);
  corners.emplace_back(left_lobe, -outer);
  corners.emplace_back(left_lobe, -inner);
  add_half_circle(inner, 270, 90);
  return {with_short_edges(corners), {{0, 0, radius}}};
}

/// The droplet of horseshoe(), with two small obstacles under each lobe.
Scene horseshoe_with_lobes_in_gaps() {
  Scene scene = horseshoe(0.4, 0.4);
  constexpr double small = 0.05, overlap = 1.2 * range;
  for (const double y : {-0.4, -0.2, 0.2, 0.4})
    scene.obstacles.push_back({0.4 + small + range - overlap, y, small});
  return scene;
}

void expect_counts(const ClogGeometry& geometry, std::int64_t wrapped, std::int64_t gaps, std::int64_t arcs) {
  EXPECT_EQ(geometry.num_wrapped, wrapped);
  EXPECT_EQ(geometry.num_gaps, gaps);
  EXPECT_EQ(geometry.num_arcs, arcs);
}

TEST(ClogGeometry, ADiscOnTwoObstaclesIsSqueezed) {
  const ClogGeometry geometry = disc_on({-40, 40}).geometry();
  expect_counts(geometry, 0, 1, 2);
  EXPECT_EQ(geometry.wrapped_support, 0);
  EXPECT_EQ(geometry.mechanism(), ClogMechanism::squeezed);
}

TEST(ClogGeometry, ADiscWedgedAgainstAnObstacleBesideItIsSqueezed) {
  // The second obstacle is beside the disc, and pushes the disc across the flow or a little downstream.
  for (const double beside : {-90.0, -100.0}) {
    const ClogGeometry geometry = disc_on({beside, 17}).geometry();
    expect_counts(geometry, 0, 1, 2);
    EXPECT_EQ(geometry.mechanism(), ClogMechanism::squeezed) << beside;
  }
}

TEST(ClogGeometry, ObstaclesFromBehindMakeNoGap) {
  expect_counts(disc_on({-40, 40, 150, 210}).geometry(), 0, 1, 4);
}

TEST(ClogGeometry, ADropletOnOneObstacleIsHeldByNeither) {
  const ClogGeometry geometry = disc_on({0}).geometry();
  expect_counts(geometry, 0, 0, 1);
  EXPECT_EQ(geometry.mechanism(), ClogMechanism::none);
}

TEST(ClogGeometry, ThereIsNoGapWithinAPost) {
  expect_counts(disc_on({-20, 20}).geometry(), 0, 1, 2);
  // Circles between the two obstacles join all of them into one post. A post is one contact.
  const ClogGeometry geometry = disc_on({-20, 20, -10, 10, 0}).geometry();
  expect_counts(geometry, 0, 0, 1);
  EXPECT_EQ(geometry.mechanism(), ClogMechanism::none);
  // Along the contour, the contact with the other obstacle comes between two contacts with the post.
  expect_counts(disc_on({-20, -10, 0, 10, 20, 100}).geometry(), 0, 1, 2);
}

/// A wall along the flow, on one side of the droplet. The droplet overlaps the wall by half the range.
Wedge side_wall(double side) { return {.tip = {0, side * (0.5 + 0.5 * range)}, .axis = {0, side}}; }

TEST(ClogGeometry, ADiscBetweenAnObstacleAndASideWallIsSqueezed) {
  for (const double side : {-1.0, 1.0}) {
    Scene scene = disc_on({-side * 40});
    EXPECT_EQ(scene.geometry().mechanism(), ClogMechanism::none);
    scene.walls = {side_wall(side)};
    const ClogGeometry geometry = scene.geometry();
    expect_counts(geometry, 0, 1, 2);
    EXPECT_EQ(geometry.wrapped_support, 0);
    EXPECT_EQ(geometry.mechanism(), ClogMechanism::squeezed) << side;
  }
}

TEST(ClogGeometry, ThereIsNoGapBetweenAWallAndAPostThatOverlapsIt) {
  for (const double side : {-1.0, 1.0}) {
    Scene apart = disc_on({side * 10}), overlapping = disc_on({side * 40});
    apart.walls = overlapping.walls = {side_wall(side)};
    expect_counts(apart.geometry(), 0, 1, 2);
    expect_counts(overlapping.geometry(), 0, 0, 2);
    EXPECT_EQ(overlapping.geometry().mechanism(), ClogMechanism::none);
    // An additional circle joins the post to the wall.
    const Obstacle circle = apart.obstacles[0];
    apart.obstacles.push_back({circle.x + 0.1, circle.y + side * 0.1, 0.2});
    apart.obstacles.push_back({circle.x + 0.15, circle.y + side * 0.25, 0.2});
    expect_counts(apart.geometry(), 0, 0, 2);
  }
}

TEST(ClogGeometry, WallsAloneHoldNothing) {
  Scene scene = disc_on({});
  scene.walls = {side_wall(-1), side_wall(1)};
  const ClogGeometry geometry = scene.geometry();
  expect_counts(geometry, 0, 0, 2);
  EXPECT_TRUE(std::isnan(geometry.wrapped_support));
  EXPECT_EQ(geometry.mechanism(), ClogMechanism::none);
  // An obstacle upstream of the disc does not support it either.
  scene = disc_on({140});
  scene.walls = {side_wall(-1)};
  EXPECT_EQ(scene.geometry().mechanism(), ClogMechanism::none);
}

/// The disc touches both surfaces of a narrow channel, which are two wedges at 45 degrees.
TEST(ClogGeometry, ADiscBetweenTheTipsOfTwoWedgesIsSqueezed) {
  Scene scene = disc_on({});
  const double r = 0.1, distance = 0.5 + r + 0.5 * range, across = 0.4;
  const double ahead = std::sqrt(distance * distance - across * across);
  for (const double side : {-1.0, 1.0})
    scene.walls.push_back({.tip = {ahead, side * (across - r)},
                           .axis = {0, side},
                           .half_angle = std::numbers::pi / 4,
                           .radius = r});
  const ClogGeometry geometry = scene.geometry();
  expect_counts(geometry, 0, 1, 2);
  EXPECT_EQ(geometry.mechanism(), ClogMechanism::squeezed);
}

TEST(ClogGeometry, ADropletHangsOverAWholePost) {
  for (const double lobe : {0.18, 0.22}) {
    Scene scene = horseshoe(lobe, lobe);
    expect_counts(scene.geometry(), 1, 0, 1);
    scene.obstacles.push_back({0.1, 0, 0.1});  // the downstream end of this obstacle is at 0.2
    expect_counts(scene.geometry(), lobe > 0.2 ? 1 : 0, 0, 1);
  }
}

TEST(ClogGeometry, NothingHoldsADropletThatTouchesNothing) {
  Scene scene = disc_on({});
  scene.obstacles.push_back({2, 0, radius});
  const ClogGeometry geometry = scene.geometry();
  expect_counts(geometry, 0, 0, 0);
  EXPECT_TRUE(std::isnan(geometry.wrapped_support));
  EXPECT_EQ(geometry.mechanism(), ClogMechanism::none);
}

TEST(ClogGeometry, AHorseshoeIsWrapped) {
  const ClogGeometry geometry = horseshoe(0.4, 0.4).geometry();
  expect_counts(geometry, 1, 0, 1);
  EXPECT_EQ(geometry.wrapped_support, 1);
  EXPECT_EQ(geometry.mechanism(), ClogMechanism::wrapped);
}

TEST(ClogGeometry, BothLobesMustReachBeyondTheObstacle) {
  EXPECT_EQ(horseshoe(0.4, radius + 0.01).geometry().num_wrapped, 1);
  EXPECT_EQ(horseshoe(0.4, radius - 0.01).geometry().num_wrapped, 0);
  EXPECT_EQ(horseshoe(radius - 0.01, 0.4).geometry().num_wrapped, 0);
}

TEST(ClogGeometry, APocketThatOpensUpstreamOrSidewaysIsNotWrapped) {
  Scene scene = horseshoe(0.4, 0.4);
  const Eigen::Index n = scene.position.size() / 2;
  Eigen::ArrayXd upstream(2 * n), sideways(2 * n);
  upstream << -scene.position;
  sideways << -scene.position.tail(n), scene.position.head(n);
  scene.position = upstream;
  EXPECT_EQ(scene.geometry().num_wrapped, 0);
  scene.position = sideways;
  EXPECT_EQ(scene.geometry().num_wrapped, 0);
}

TEST(ClogGeometry, AHorseshoeWhoseLobesStandInGapsIsHybrid) {
  const ClogGeometry geometry = horseshoe_with_lobes_in_gaps().geometry();
  EXPECT_EQ(geometry.num_wrapped, 1);
  EXPECT_EQ(geometry.num_arcs, 5);
  EXPECT_GE(geometry.num_gaps, 2);
  EXPECT_GT(geometry.wrapped_support, 0.4);
  EXPECT_LT(geometry.wrapped_support, 0.6);
  EXPECT_EQ(geometry.mechanism(), ClogMechanism::hybrid);
}

/// A wrapped obstacle and an obstacle under a lobe share the support in proportion to their forces against
/// the flow.
TEST(ClogGeometry, WeighsSupportByTheForceAgainstTheFlow) {
  Scene scene = horseshoe(0.4, 0.4);
  // Under one lobe, with an overlap of the whole range.
  scene.obstacles.push_back({0.4 + radius, 0.3, radius});
  const double before = horseshoe(0.4, 0.4).geometry().wrapped_support;
  EXPECT_EQ(before, 1);
  // The half ring has the overlap range/2 along a width of 2 inner. The flat end of the lobe is at the
  // distance `radius` from the obstacle's centre. At a distance s from the middle of this end, the overlap is
  // range - s^2/(2 radius). The integral of this overlap is 4/3 sqrt(2 radius range) range.
  const double ring = range / 2 * 2 * inner;
  const double flat = 4.0 / 3 * std::sqrt(2 * radius * range) * range;
  EXPECT_NEAR(scene.geometry().wrapped_support, ring / (ring + flat), 0.04);
}

TEST(ClogGeometry, IsTheSameWhereverTheDropletIs) {
  const Scene scene = horseshoe_with_lobes_in_gaps();
  const ClogGeometry expected = scene.geometry();
  DpParameters as_it_is;  // uses the edges of the polygon itself
  as_it_is.wall_contact = WallContact::vertex;
  as_it_is.contact_range = range;
  // Two of these places are at borders of the box.
  for (const Eigen::Array2d& place :
       {Eigen::Array2d(10, 10), Eigen::Array2d(19.9, 10), Eigen::Array2d(0.05, 19.95)}) {
    std::vector<Obstacle> moved = scene.obstacles;
    for (Obstacle& obstacle : moved) obstacle.x += place[0], obstacle.y += place[1];
    const ObstacleArray array(20, moved);
    DropletState state = test::state_of(scene.position);
    state.frame.origin = place;
    const ClogGeometry found = clog_geometry(state, array, as_it_is);
    expect_counts(found, expected.num_wrapped, expected.num_gaps, expected.num_arcs);
    EXPECT_NEAR(found.wrapped_support, expected.wrapped_support, 1e-9);
  }
}

TEST(ClogGeometry, FindsWallsWhereverTheDropletIs) {
  Scene scene = disc_on({-40});
  scene.walls = {side_wall(1)};
  DpParameters as_it_is;
  as_it_is.wall_contact = WallContact::vertex;
  as_it_is.contact_range = range;
  for (const Eigen::Array2d& place : {Eigen::Array2d(10, 10), Eigen::Array2d(0.05, 3)}) {
    std::vector<Obstacle> moved = scene.obstacles;
    for (Obstacle& obstacle : moved) obstacle.x += place[0], obstacle.y += place[1];
    std::vector<Wedge> walls = scene.walls;
    walls[0].tip += place;
    const ObstacleArray array(Period{20, 1}, moved, walls);
    DropletState state = test::state_of(scene.position);
    state.frame.origin = place;
    const ClogGeometry found = clog_geometry(state, array, as_it_is);
    expect_counts(found, 0, 1, 2);
    EXPECT_EQ(found.mechanism(), ClogMechanism::squeezed);
  }
}

TEST(ClogGeometry, IsTheSameInAMirror) {
  for (const Scene& scene : {horseshoe_with_lobes_in_gaps(), disc_on({-30, 45}), horseshoe(0.4, 0.2)}) {
    const ClogGeometry expected = scene.geometry();
    Scene mirrored = scene;
    const Eigen::Index n = scene.position.size() / 2;
    mirrored.position.head(n) = scene.position.head(n).reverse();
    mirrored.position.tail(n) = -scene.position.tail(n).reverse();
    for (Obstacle& obstacle : mirrored.obstacles) obstacle.y *= -1;
    const ClogGeometry found = mirrored.geometry();
    expect_counts(found, expected.num_wrapped, expected.num_gaps, expected.num_arcs);
    EXPECT_NEAR(found.wrapped_support, expected.wrapped_support, 1e-9);
  }
}

TEST(ClogGeometry, DoesNotDependOnTheFirstVertex) {
  const Scene scene = horseshoe_with_lobes_in_gaps();
  const ClogGeometry expected = scene.geometry();
  const Eigen::Index n = scene.position.size() / 2;
  for (const Eigen::Index shift : {Eigen::Index{1}, n / 3, n - 5}) {
    Scene turned = scene;
    for (Eigen::Index i = 0; i < n; ++i) {
      turned.position[i] = scene.position[(i + shift) % n];
      turned.position[n + i] = scene.position[n + (i + shift) % n];
    }
    const ClogGeometry found = turned.geometry();
    expect_counts(found, expected.num_wrapped, expected.num_gaps, expected.num_arcs);
    EXPECT_NEAR(found.wrapped_support, expected.wrapped_support, 1e-9);
  }
}

}  // namespace
}  // namespace clog

#include "clog/core/polygon/neck.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "clog/core/droplet/shape.hpp"
#include "support.hpp"

namespace clog {
namespace {

using std::numbers::pi;

Eigen::ArrayXd polygon_of(const std::vector<Eigen::Array2d>& points) {
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::ArrayXd position(2 * n);
  for (Eigen::Index i = 0; i < n; ++i) position[i] = points[i][0], position[n + i] = points[i][1];
  return position;
}

/// Points at equal steps of an angle that goes from 0 to a full turn.
template <class Point>
Eigen::ArrayXd closed_curve(int num_vertices, Point point) {
  std::vector<Eigen::Array2d> points;
  points.reserve(num_vertices);
  for (int i = 0; i < num_vertices; ++i) points.push_back(point(2 * pi * i / num_vertices));
  return polygon_of(points);
}

Eigen::ArrayXd ellipse_of_axes(int num_vertices, double along, double across) {
  return closed_curve(num_vertices,
                      [=](double t) { return Eigen::Array2d(along * std::cos(t), across * std::sin(t)); });
}

Eigen::ArrayXd turned(const Eigen::ArrayXd& position, double angle) {
  const Eigen::Index n = position.size() / 2;
  Eigen::ArrayXd result(2 * n);
  result.head(n) = std::cos(angle) * position.head(n) - std::sin(angle) * position.tail(n) + 3;
  result.tail(n) = std::sin(angle) * position.head(n) + std::cos(angle) * position.tail(n) - 2;
  return result;
}

void add_arc(std::vector<Eigen::Array2d>& points, const Eigen::Array2d& centre, double radius, double from,
             double to, int pieces) {
  for (int i = 0; i <= pieces; ++i) {
    const double t = from + (to - from) * i / pieces;
    points.emplace_back(centre + radius * Eigen::Array2d(std::cos(t), std::sin(t)));
  }
}

/// Two circles on the x axis, joined by a bridge with straight sides.
Eigen::ArrayXd bridged_circles(double left_radius, double right_radius, double width, int pieces,
                               double distance = 2) {
  const double left = std::asin(width / 2 / left_radius), right = std::asin(width / 2 / right_radius);
  std::vector<Eigen::Array2d> points;
  add_arc(points, {0, 0}, left_radius, left, 2 * pi - left, pieces);
  add_arc(points, {distance, 0}, right_radius, pi + right, 3 * pi - right, pieces);
  return polygon_of(points);
}

Eigen::ArrayXd stadium(double straight, double width, int pieces) {
  std::vector<Eigen::Array2d> points;
  add_arc(points, {straight / 2, 0}, width / 2, -pi / 2, pi / 2, pieces);
  for (int i = 1; i < pieces; ++i) points.emplace_back(straight / 2 - straight * i / pieces, width / 2);
  add_arc(points, {-straight / 2, 0}, width / 2, pi / 2, 3 * pi / 2, pieces);
  for (int i = 1; i < pieces; ++i) points.emplace_back(-straight / 2 + straight * i / pieces, -width / 2);
  return polygon_of(points);
}

TEST(ThinnestNeck, IsTheBridgeBetweenTwoCircles) {
  for (const double width : {0.001, 0.03, 0.2})
    for (const int pieces : {15, 64, 301})
      for (const double angle : {0.0, 0.4, 2.0})
        EXPECT_NEAR(thinnest_neck(turned(bridged_circles(0.6, 0.5, width, pieces), angle)).width, width,
                    1e-12)
            << pieces << " pieces, turned by " << angle;
}

/// A convex shape has no neck, even if it is thin or has few vertices.
TEST(ThinnestNeck, IsNotThereInCirclesAndEllipses) {
  for (const int num_vertices : {32, 128, 129, 512, 2048})
    for (const double across : {0.5, 0.1, 0.01, 0.001})
      for (const double angle : {0.0, 0.7})
        EXPECT_EQ(thinnest_neck(turned(ellipse_of_axes(num_vertices, 0.5, across), angle)).width, INFINITY)
            << num_vertices << " vertices, " << across;
}

/// Half of a stadium has the area w L/2 + pi w^2/8, if w is its width and L the length of its straight part.
TEST(ThinnestNeck, IsTheWidthOfAStadiumIfItsHalvesAreLobes) {
  const double width = 0.1, enough = 2 * (pi - pi / 8) * width;
  EXPECT_NEAR(thinnest_neck(stadium(1.01 * enough, width, 64)).width, width, 1e-12);
  EXPECT_EQ(thinnest_neck(stadium(0.99 * enough, width, 64)).width, INFINITY);
}

/// The bridge is very short. The diameter of the smaller circle is 1.8 or 2.2 times the width of the bridge.
TEST(ThinnestNeck, JoinsPartsThatAreTwiceAsWide) {
  const double width = 0.2;
  EXPECT_EQ(thinnest_neck(bridged_circles(0.6, 0.9 * width, width, 64, 0.75)).width, INFINITY);
  EXPECT_NEAR(thinnest_neck(bridged_circles(0.6, 1.1 * width, width, 64, 0.79)).width, width, 1e-12);
}

/// The area of the smaller circle is 0.019 or 0.021 times the area of both circles together.
TEST(ThinnestNeck, JoinsPartsOfTwoHundredthsOfTheArea) {
  const double width = 0.01;
  for (const double share : {0.019, 0.021}) {
    const double radius = 0.5 * std::sqrt(share / (1 - share));
    const double neck = thinnest_neck(bridged_circles(0.5, radius, width, 128, 0.5 + radius)).width;
    EXPECT_EQ(neck<1, share> 0.02) << neck;
  }
}

/// For points on this oval, the product of the distances from two points at +-a is b^2. For a < b < sqrt(2) a
/// the oval is 2 sqrt(b^2 - a^2) wide in the middle. An edge of length l in the middle is a chord of the
/// oval. The distance between chord and oval is l^2/8 times the oval's curvature.
TEST(ThinnestNeck, OfACassiniOvalConvergesAsTheContourDoes) {
  const double a = 0.5;
  for (const double b : {0.5004, 0.502, 0.51}) {
    const double exact = 2 * std::sqrt(b * b - a * a);
    double last_error = INFINITY;
    for (const int num_vertices : {130, 258, 514, 1026}) {  // these numbers leave no vertex in the middle
      const double neck = thinnest_neck(closed_curve(num_vertices, [=](double t) {
                            const double s = std::sin(2 * t);
                            const double r = std::sqrt(a * a * std::cos(2 * t) +
                                                       std::sqrt(std::pow(b, 4) - std::pow(a, 4) * s * s));
                            return Eigen::Array2d(r * std::cos(t), r * std::sin(t));
                          })).width;
      const double error = std::abs(neck - exact);
      EXPECT_LT(error, 3 / std::pow(num_vertices, 2) / exact);
      EXPECT_LT(error, 0.5 * last_error) << b << ", " << num_vertices;
      last_error = error;
    }
  }
}

TEST(ThinnestNeck, DoesNotDependOnWhereTheContourBegins) {
  const Eigen::ArrayXd shape = test::dumbbell(128, 0.04);
  const double width = thinnest_neck(shape).width;
  EXPECT_NEAR(width, 0.04, 1e-3);
  for (const int first : {1, 31, 32, 64, 127})
    EXPECT_NEAR(thinnest_neck(test::renumbered(shape, first)).width, width, 1e-15);
}

TEST(ThinnestNeck, IsLookedForBelowABoundOnly) {
  const Eigen::ArrayXd shape = bridged_circles(0.6, 0.5, 0.1, 64);
  EXPECT_NEAR(thinnest_neck(shape, 0.1001).width, 0.1, 1e-12);
  EXPECT_EQ(thinnest_neck(shape, 0.0999).width, INFINITY);
}

/// A film over an obstacle, and two lobes with water between them. The film is thickest at its ends. The
/// water is no neck, even if the lobes are close together.
TEST(ThinnestNeck, IsTheFilmAboveAnObstacleAndNotTheGapBetweenLobes) {
  const double inner = 0.15, film = 0.04, lobe = 0.3, gap = 0.01;
  std::vector<Eigen::Array2d> points;
  // Upstream is to the left. The two sides of the film have different centres, so that the film is thinnest
  // in the middle.
  add_arc(points, {0.05, 0}, inner + film + 0.05, pi / 2, 3 * pi / 2, 40);
  points.emplace_back(lobe, -(inner + film + 0.05));
  points.emplace_back(lobe, -gap / 2);
  points.emplace_back(inner + 0.05, -gap / 2);
  add_arc(points, {0, 0}, inner, 1.7 * pi, 0.3 * pi, 40);
  points.emplace_back(inner + 0.05, gap / 2);
  points.emplace_back(lobe, gap / 2);
  points.emplace_back(lobe, inner + film + 0.05);
  EXPECT_NEAR(thinnest_neck(polygon_of(points)).width, film, 1e-3);
}

TEST(ThinnestNeck, HasOneLineOfSight) {
  // Two parallel bars are joined at one end. The outer sides of the bars face each other, too, but a line
  // between these sides crosses the water between the bars, so it is no neck.
  const Eigen::ArrayXd bars =
      polygon_of({{0, 0}, {2, 0}, {2, 0.3}, {0.5, 0.3}, {0.5, 0.35}, {2, 0.35}, {2, 0.65}, {0, 0.65}});
  EXPECT_NEAR(thinnest_neck(bars).width, 0.3, 1e-12);
}

}  // namespace
}  // namespace clog

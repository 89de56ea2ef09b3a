#include "clog/core/droplet/shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "clog/core/tools/units.hpp"
#include "support.hpp"

namespace clog {
namespace {

/// Counts the crossings of every pair of edges by solving p + s u = q + t v for s and t. The tested function
/// uses another formula.
int crossings_of_every_pair(const Eigen::ArrayXd& position) {
  const int n = static_cast<int>(position.size() / 2);
  const auto point = [&](int i) { return Eigen::Array2d(position[i % n], position[n + i % n]); };
  const auto cross = [](const Eigen::Array2d& a, const Eigen::Array2d& b) {
    return a[0] * b[1] - a[1] * b[0];
  };
  int crossings = 0;
  for (int i = 0; i < n; ++i)
    for (int j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      const Eigen::Array2d u = point(i + 1) - point(i);
      const Eigen::Array2d v = point(j + 1) - point(j);
      const Eigen::Array2d between = point(j) - point(i);
      const double s = cross(between, v) / cross(u, v);
      const double t = cross(between, u) / cross(u, v);
      crossings += s > 0 && s < 1 && t > 0 && t < 1;
    }
  return crossings;
}

TEST(Polygon, ARegularOneHasTheAreaAndEdgesAskedFor) {
  for (const int n : {16, 64, 256, 1024}) {
    const PolygonShape shape = polygon_shape(regular_polygon(n, units::rest_area));
    EXPECT_NEAR(shape.area, units::rest_area, 1e-12);
    EXPECT_NEAR(shape.perimeter, n * units::regular_edge_length(n), 1e-11);
    // The shape parameter A of a regular polygon is (n/pi) tan(pi/n).
    EXPECT_NEAR(shape.shape_parameter(), n / std::numbers::pi * std::tan(std::numbers::pi / n), 1e-12);
  }
}

TEST(Polygon, ARectangleIsMeasuredExactly) {
  Eigen::ArrayXd position(8);
  position << 1, 4, 4, 1, 2, 2, 4, 4;
  const PolygonShape shape = polygon_shape(position);
  EXPECT_DOUBLE_EQ(shape.area, 6);
  EXPECT_DOUBLE_EQ(shape.perimeter, 10);
  EXPECT_DOUBLE_EQ(area_centroid(position)[0], 2.5);
  EXPECT_DOUBLE_EQ(area_centroid(position)[1], 3);
}

TEST(Polygon, TheCentroidsVelocityIsItsRateOfChange) {
  Eigen::ArrayXd position = regular_polygon(20, units::rest_area);
  Eigen::ArrayXd velocity(position.size());
  for (Eigen::Index i = 0; i < position.size(); ++i) {
    position[i] += 0.1 * std::sin(3.7 * static_cast<double>(i)) + 0.4;
    velocity[i] = std::cos(1.3 * static_cast<double>(i));
  }
  const double dt = 1e-5;
  const Eigen::Array2d change =
      (area_centroid(position + dt * velocity) - area_centroid(position - dt * velocity)) / (2 * dt);
  const Eigen::Array2d rate = area_centroid_velocity(position, velocity);
  EXPECT_NEAR(rate[0], change[0], 1e-8);
  EXPECT_NEAR(rate[1], change[1], 1e-8);
}

TEST(Refined, HasTheVerticesAndTheMiddlesOfCubics) {
  // The vertices are on the curve y = x^3 - x, and their x are a unit apart. The cubic through four of them
  // is the curve itself.
  Eigen::ArrayXd position(2 * 16);
  for (int i = 0; i < 16; ++i) {
    position[i] = i;
    position[16 + i] = i * i * i - i;
  }
  const Eigen::ArrayXd fine = refined(position);
  ASSERT_EQ(fine.size(), 4 * 16);
  for (Eigen::Index i = 0; i < 16; ++i) {
    EXPECT_EQ(fine[2 * i], position[i]);
    EXPECT_EQ(fine[32 + 2 * i], position[16 + i]);
  }
  for (int i = 1; i < 14; ++i) {
    const double x = i + 0.5;
    EXPECT_NEAR(fine[2 * i + 1], x, 1e-12);
    EXPECT_NEAR(fine[32 + 2 * i + 1], x * x * x - x, 1e-9);
  }
}

TEST(Refined, IsOnACircleToFourthOrder) {
  const auto error = [](int n) {
    const Eigen::ArrayXd polygon = regular_polygon(n, units::rest_area), fine = refined(polygon);
    const double radius = std::hypot(polygon[0], polygon[n]);
    return std::abs(std::hypot(fine[1], fine[2 * n + 1]) - radius);
  };
  EXPECT_NEAR(std::log2(error(32) / error(64)), 4, 0.05);
}

TEST(DistanceToSegment, IsThatOfTheNearestPoint) {
  EXPECT_DOUBLE_EQ(distance_to_segment({1, 2}, {0, 0}, {3, 0}), 2);
  EXPECT_DOUBLE_EQ(distance_to_segment({-3, 4}, {0, 0}, {3, 0}), 5);
  EXPECT_DOUBLE_EQ(distance_to_segment({6, 4}, {0, 0}, {3, 0}), 5);
  EXPECT_DOUBLE_EQ(distance_to_segment({3, 4}, {0, 0}, {0, 0}), 5);
}

TEST(Polygon, EnclosesWhatIsInside) {
  Eigen::ArrayXd position(12);  // a U, open at the top
  position << 0, 3, 3, 2, 1, 0, 0, 0, 3, 1, 1, 3;
  EXPECT_TRUE(encloses(position, 1.5, 0.5));
  EXPECT_FALSE(encloses(position, 1.5, 2.0));
  EXPECT_TRUE(encloses(position, 2.8, 2.0));
  EXPECT_FALSE(encloses(position, -1, 0.5));
}

TEST(SelfCrossings, AreNoneInAConvexOrAWaistedContour) {
  for (const int n : {16, 256, 4096}) {
    EXPECT_EQ(num_self_crossings(regular_polygon(n, units::rest_area)), 0);
    EXPECT_EQ(num_self_crossings(test::dumbbell(n, 0.01)), 0);
  }
}

TEST(SelfCrossings, AreOneInAFigureOfEight) {
  for (const int n : {16, 17, 256, 4095}) {
    Eigen::ArrayXd position(2 * n);
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.25) / n;
      position[i] = std::cos(angle);
      position[n + i] = std::sin(2 * angle);
    }
    EXPECT_EQ(num_self_crossings(position), 1) << n << " vertices";
    // The edges of this contour are sorted along y, because the contour extends farther along y than along x.
    Eigen::ArrayXd turned(2 * n);
    turned << position.tail(n), 2 * position.head(n);
    EXPECT_EQ(num_self_crossings(turned), 1) << n << " vertices, turned";
  }
}

TEST(SelfCrossings, CountWhereAFilmIsPulledThroughItself) {
  // The lower side of a flat box bulges out through the upper side.
  Eigen::ArrayXd position(12);
  position << 0, 1, 2, 3, 3, 0, 0, 0, 2, 0, 1, 1;
  EXPECT_EQ(num_self_crossings(position), 2);
  EXPECT_GT(polygon_shape(position).area, 0);
}

TEST(SelfCrossings, DoNotCountWhatOnlyTouches) {
  Eigen::ArrayXd position(10);  // the lower side of this square has a vertex on the upper side
  position << 0, 1, 2, 2, 0, 0, 1, 0, 1, 1;
  EXPECT_EQ(num_self_crossings(position), 0);
}

TEST(SelfCrossings, AreThoseOfEveryPairOfEdges) {
  int most = 0;
  for (unsigned seed = 1; seed <= 60; ++seed)
    for (const double amount : {0.01, 0.05, 0.2, 1.0}) {
      const Eigen::ArrayXd position = test::shaken(regular_polygon(128, units::rest_area), amount, seed);
      const int expected = crossings_of_every_pair(position);
      EXPECT_EQ(num_self_crossings(position), expected) << "seed " << seed << ", shaken by " << amount;
      most = std::max(most, expected);
    }
  EXPECT_GT(most, 100);
}

}  // namespace
}  // namespace clog

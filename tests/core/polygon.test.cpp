#include "clog/core/polygon.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "clog/core/units.hpp"

namespace clog {
namespace {

TEST(Polygon, ARegularOneHasTheAreaAndEdgesAskedFor) {
  for (const int n : {16, 64, 256, 1024}) {
    const PolygonShape shape = polygon_shape(regular_polygon(n, units::rest_area));
    EXPECT_NEAR(shape.area, units::rest_area, 1e-12);
    EXPECT_NEAR(shape.perimeter, n * units::regular_edge_length(n), 1e-11);
    // A of a regular polygon: (n/pi) tan(pi/n).
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

}  // namespace
}  // namespace clog

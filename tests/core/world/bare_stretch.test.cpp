#include "clog/core/world/bare_stretch.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace clog {
namespace {

constexpr double period = 20;

std::optional<Stretch> along(const std::vector<double>& places, double radius = 0.5) {
  std::vector<Obstacle> circles;
  circles.reserve(places.size());
  for (const double x : places) circles.push_back({x, 3, radius});
  return conspicuous_bare_stretch(circles, &Obstacle::x, period);
}

TEST(BareStretch, IsNoneInAnArrayThatFillsItsPeriod) {
  EXPECT_FALSE(along({1, 5, 9, 13, 17}));
  EXPECT_FALSE(along({1, 5.5, 9, 12.5, 17})) << "irregular as they may be";
}

TEST(BareStretch, IsWhereTheCirclesEndBeforeThePeriod) {
  const auto bare = along({1, 3, 5, 7, 9});
  ASSERT_TRUE(bare);
  EXPECT_DOUBLE_EQ(bare->begin, 9.5);
  EXPECT_DOUBLE_EQ(bare->end, 20.5) << "where the first circle's image begins";
}

TEST(BareStretch, MayBeAmongTheCircles) {
  const auto bare = along({17, 1, 3, 15, 19, 13});
  ASSERT_TRUE(bare);
  EXPECT_DOUBLE_EQ(bare->begin, 3.5);
  EXPECT_DOUBLE_EQ(bare->end, 12.5);
}

TEST(BareStretch, IsNotWhatACircleCoversOverTheBorder) {
  // The last circle covers 13 to 26, and across the periodic border also 0 to 6. This leaves two bare
  // stretches, from 6 to 9.4 and from 10.4 to 12.
  const std::vector<Obstacle> circles = {{2, 3, 0.5}, {9.9, 3, 0.5}, {12.5, 3, 0.5}, {19.5, 12, 6.5}};
  EXPECT_FALSE(conspicuous_bare_stretch(circles, &Obstacle::x, period));
}

TEST(BareStretch, IsSeenAcrossAsWell) {
  const std::vector<Obstacle> row = {{1, 3, 0.5}, {5, 3, 0.5}, {9, 4, 0.5}, {13, 3, 0.5}, {17, 3, 0.5}};
  const auto bare = conspicuous_bare_stretch(row, &Obstacle::y, period);
  ASSERT_TRUE(bare);
  EXPECT_DOUBLE_EQ(bare->begin, 4.5);
  EXPECT_DOUBLE_EQ(bare->end, 22.5);
}

TEST(BareLanes, AreAllThatADropletFallsThrough) {
  // Two walls at y = 1 and 7 are in an array of width 8. One wide lane is between the walls. Another lane
  // leads across the periodic border from one wall to the other.
  std::vector<Obstacle> walls;
  for (int i = 0; i < 30; ++i)
    for (const double y : {1.0, 7.0}) walls.push_back({0.5 * i, y, 0.15});
  const std::vector<Stretch> lanes = bare_lanes(walls, 8);
  ASSERT_EQ(lanes.size(), 2u);
  EXPECT_NEAR(lanes[0].begin, 1.15, 1e-12);
  EXPECT_NEAR(lanes[0].end, 6.85, 1e-12);
  EXPECT_NEAR(lanes[1].begin, 7.15, 1e-12);
  EXPECT_NEAR(lanes[1].end, 8.85, 1e-12);
  EXPECT_EQ(bare_lanes(walls, 8.0 - 0.75).size(), 1u) << "the backs leave 0.95 now";
  EXPECT_TRUE(bare_lanes({}, 8).empty());
}

TEST(BareStretch, OfASingleCircleIsItsArray) { EXPECT_FALSE(along({5})); }

TEST(BareStretch, IsNoneWhereAllIsCovered) { EXPECT_FALSE(along({2, 7, 12, 17}, 2.6)); }

}  // namespace
}  // namespace clog

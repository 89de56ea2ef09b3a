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
  // The shadow of the last one reaches from 15 to 24, of which 0 to 4 are the period's begin.
  std::vector<Obstacle> circles = {{6, 3, 0.5}, {9, 3, 0.5}, {12, 3, 0.5}, {19.5, 10, 4.5}};
  EXPECT_FALSE(conspicuous_bare_stretch(circles, &Obstacle::x, period));
  circles.back().radius = 0.5;
  const auto bare = conspicuous_bare_stretch(circles, &Obstacle::x, period);
  EXPECT_FALSE(bare) << "6.5 from 12.5 to 19 is not wider than 5.5 from 20 to 25.5 twice";
}

TEST(BareStretch, IsSeenAcrossAsWell) {
  const std::vector<Obstacle> row = {{1, 3, 0.5}, {5, 3, 0.5}, {9, 4, 0.5}, {13, 3, 0.5}, {17, 3, 0.5}};
  const auto bare = conspicuous_bare_stretch(row, &Obstacle::y, period);
  ASSERT_TRUE(bare);
  EXPECT_DOUBLE_EQ(bare->begin, 4.5);
  EXPECT_DOUBLE_EQ(bare->end, 22.5);
}

TEST(BareStretch, OfASingleCircleIsItsArray) { EXPECT_FALSE(along({5})); }

TEST(BareStretch, IsNoneWhereAllIsCovered) { EXPECT_FALSE(along({2, 7, 12, 17}, 2.6)); }

}  // namespace
}  // namespace clog

#include "clog/campaign/angle_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "clog/core/tools/error.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::campaign {
namespace {

/// Rows that rise by three in four: their sine is 0.6, their cosine 0.8.
constexpr double steep = 36.86989764584402;
constexpr double spacing = 2;

TriedAngle after(double along, double across) {
  TriedAngle angle{.angle = steep};
  count_run(angle, along, across, spacing);
  return angle;
}

TEST(CountRun, FollowsTheRowsIfItEndsInTheLaneItBeganIn) {
  EXPECT_TRUE(after(20, 15).follows());
  EXPECT_TRUE(after(20, 15 - 0.99 * spacing / 0.8).follows()) << "almost a row off";
}

TEST(CountRun, LeavesTheRowsIfItComesARowOff) {
  EXPECT_TRUE(after(20, 15 - 1.01 * spacing / 0.8).leaves());
  EXPECT_TRUE(after(20, 0).leaves()) << "along the flow";
  EXPECT_TRUE(after(20, 15 + 1.01 * spacing / 0.8).leaves()) << "to the other side";
}

TEST(CountRun, SaysNothingOfAWayOnWhichNoDropletCanLeaveThem) {
  const TriedAngle angle = after(1.99 * spacing / 0.6, 0.75 * 1.99 * spacing / 0.6);
  EXPECT_FALSE(angle.follows());
  EXPECT_FALSE(angle.leaves());
  EXPECT_EQ(angle.num_short, 1);
}

TriedAngle follows(double angle) { return {.angle = angle, .num_following = 2}; }
TriedAngle leaves(double angle) { return {.angle = angle, .num_following = 1, .num_leaving = 1}; }
TriedAngle short_at(double angle) { return {.angle = angle, .num_short = 2}; }

TEST(CriticalBracket, LiesBelowTheFirstAngleAtWhichSomeDropletLeaves) {
  const AngleBracket bracket = critical_bracket(
      std::vector{follows(5), follows(10), short_at(12), leaves(15), follows(26), leaves(30)});
  EXPECT_EQ(bracket.lower, 10);
  EXPECT_EQ(bracket.upper, 15);
}

TEST(CriticalBracket, IsOpenWhereNothingIsKnown) {
  EXPECT_TRUE(std::isnan(critical_bracket(std::vector{follows(5), follows(40)}).upper));
  EXPECT_TRUE(std::isnan(critical_bracket(std::vector{short_at(5), leaves(40)}).lower));
}

TEST(AngleSearch, BeginsAtTheBoundsAndTheQuartersBetweenThem) {
  sweep::Settings settings;
  for (const auto& [key, text] :
       {std::pair("obstacle-layout", "lattice"), std::pair("obstacle-gap", "0.8"), std::pair("box", "60"),
        std::pair("seeds", "1,3"), std::pair("lattice-angle", "5.2,45")})
    settings.set(key, text);
  const sweep::Points first = AngleSearch(settings, {.width = 1}).first().points();
  ASSERT_EQ(first.rows.size(), 5u);
  for (std::size_t i = 0; i < first.rows.size(); ++i) {
    EXPECT_NEAR(std::stod(first.rows[i][0]), 5.2 + 9.95 * static_cast<double>(i), 0.1);
    EXPECT_EQ(first.rows[i][1], "1,3");
  }
  settings.set("lattice-angle", "0,45");
  EXPECT_THROW(AngleSearch(settings, {.width = 1}), Error);
}

}  // namespace
}  // namespace clog::campaign

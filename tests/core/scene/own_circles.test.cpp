#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "clog/core/parameters/circles.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/error.hpp"

namespace clog {
namespace {

RunParameters among(std::vector<Obstacle> circles) {
  RunParameters run;
  run.dp.vertices = 64;
  run.obstacles.layout = ObstacleLayout::file;
  run.obstacles.box = 10;
  run.obstacles.own = OwnCircles(std::move(circles), "posts.csv");
  return run;
}

std::string refusal(const RunParameters& run) {
  try {
    resolve(run);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(OwnCircles, AreKnownByAStandardCheckSum) {
  // Of the 24 bytes "123456789" and 15 zeros, as three numbers: CRC-64/XZ, computed bit by bit with Python.
  Obstacle text;
  const char bytes[sizeof text] = "123456789";
  std::memcpy(&text, bytes, sizeof text);
  EXPECT_EQ(OwnCircles({text}).check_sum(), "b2f0675da29a87f6");
  EXPECT_NE(OwnCircles({{1, 2, 3}}), OwnCircles({{1, 2, 4}}));
  EXPECT_EQ(OwnCircles({{1, 2, 3}}, "a"), OwnCircles({{1, 2, 3}}, "b"));
  const OwnCircles known({{1, 2, 3}});
  const OwnCircles other = OwnCircles::from_check_sum(known.check_sum());
  EXPECT_EQ(other, known);
  EXPECT_FALSE(other.are_known());
  EXPECT_THROW(other.circles(), Error);
  for (const char* wrong : {"", "12", "123456789012345g", "12345678901234567"})
    EXPECT_THROW(OwnCircles::from_check_sum(wrong), Error) << wrong;
}

TEST(OwnCircles, HaveTheGapAndTheDensityOfTheirFile) {
  const RunParameters run = resolve(among({{2, 5, 0.25}, {3, 5, 0}}));
  EXPECT_NEAR(run.obstacles.gap, 1 - 0.25 - 0.15, 1e-12) << "a radius of 0 is half of obstacle-diameter";
  EXPECT_DOUBLE_EQ(run.obstacles.density.per_area.value(), 0.02);
  EXPECT_EQ(scene_of(run).walls(run).obstacles().size(), 2u);
  EXPECT_EQ(resolve(run).obstacles, run.obstacles) << "resolved once more nothing changes";
}

TEST(OwnCircles, AreRefusedWithTheirPlaces) {
  EXPECT_NE(
      refusal(among({{2, 5, 0.5}, {2.5, 5, 0.5}})).find("posts.csv (those at x=2, y=5 and x=2.5, y=5 touch"),
      std::string::npos);
  EXPECT_NE(refusal(among({{0.1, 5, 0.5}, {9.9, 5, 0.5}})).find("across the border"), std::string::npos);
  EXPECT_NE(refusal(among({{11, 5, 0.5}})).find("outside the array"), std::string::npos);
  EXPECT_NE(refusal(among({{std::nan(""), 5, 0.5}})).find("outside the array"), std::string::npos);
  EXPECT_NE(refusal(among({{5, 5, 5}})).find("periodic image"), std::string::npos);
  EXPECT_NE(refusal(among({{5, 5, 0.5}, {6.04, 5, 0.5}})).find("not wider than an edge"), std::string::npos);
  RunParameters none = among({});
  EXPECT_NE(refusal(none).find("there are none"), std::string::npos);
  none.obstacles.own.reset();
  EXPECT_NE(refusal(none).find("obstacles=FILE.csv"), std::string::npos);
}

TEST(OwnCircles, AreShiftedSoThatTheDropletStartsAnywhere) {
  // Uniform: of many places the mean of cos(2 pi x/L) is 0 within its standard error of 1/sqrt(2 n).
  RunParameters run = resolve(among({{5, 5, 0.3}}));
  const ObstacleArray fixed = scene_of(run).walls(run);
  EXPECT_EQ(fixed.obstacles()[0].x, 5);
  run.obstacles.release = Release::anywhere;
  double sum_x = 0, sum_y = 0;
  constexpr int number = 2000;
  for (run.seed = 0; run.seed < number; ++run.seed) {
    const ObstacleArray walls = scene_of(run).walls(run);
    sum_x += std::cos(2 * std::numbers::pi * walls.obstacles()[0].x / 10);
    sum_y += std::cos(2 * std::numbers::pi * walls.obstacles()[0].y / 10);
  }
  const double error = 1 / std::sqrt(2.0 * number);
  EXPECT_LT(std::abs(sum_x / number), 4 * error);
  EXPECT_LT(std::abs(sum_y / number), 4 * error);
}

}  // namespace
}  // namespace clog

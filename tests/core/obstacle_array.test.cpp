#include "clog/core/obstacle_array.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "clog/core/error.hpp"

namespace clog {
namespace {

double brute_force_gap(const ObstacleArray& array) {
  double smallest = 1e9;
  const auto& all = array.obstacles();
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double dx = std::remainder(all[i].x - all[j].x, array.box());
      const double dy = std::remainder(all[i].y - all[j].y, array.box());
      smallest = std::min(smallest, std::hypot(dx, dy) - all[i].radius - all[j].radius);
    }
  return smallest;
}

TEST(SampleObstacles, KeepsTheGapPeriodicImagesIncluded) {
  for (const double box : {10.0, 17.3, 40.0})
    for (const double gap : {0.2, 0.5, 1.1}) {
      const ObstacleArray array =
          sample_obstacles({.gap = gap, .diameter = 0.3, .density = {}, .box = box}, 11);
      EXPECT_GE(brute_force_gap(array), gap) << "box " << box;
      EXPECT_NEAR(brute_force_gap(array), gap, 0.05) << "a saturated array comes close to its gap";
      EXPECT_DOUBLE_EQ(array.smallest_gap(), brute_force_gap(array));
    }
}

TEST(SampleObstacles, SaturatesAtTheJammingLimitOfRandomSequentialAddition) {
  // Coverage 0.547069 of discs of diameter gap + sigma_ob; finite boxes scatter by less than 0.001 here.
  double coverage = 0;
  for (const std::uint32_t seed : {1u, 2u, 3u, 4u}) {
    const ObstacleArray array =
        sample_obstacles({.gap = 0.2, .diameter = 0.3, .density = {}, .box = 100}, seed);
    coverage += static_cast<double>(array.obstacles().size()) / 1e4 * std::numbers::pi / 4 * 0.25 / 4;
  }
  EXPECT_NEAR(coverage, 0.547069, 0.001);
}

TEST(SampleObstacles, LeavesNoRoomForOneMoreWhenSaturated) {
  const ObstacleArray array = sample_obstacles({.gap = 0.4, .diameter = 0.3, .density = {}, .box = 30}, 4);
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> uniform(0, 30);
  for (int i = 0; i < 20000; ++i) {
    std::vector<Obstacle> near;
    array.gather({uniform(engine), uniform(engine), 0, 0, 0, 0, 0.6}, near);
    EXPECT_TRUE(std::any_of(near.begin(), near.end(),
                            [](const Obstacle& o) { return std::hypot(o.x, o.y) < 0.7001; }));
  }
}

TEST(SampleObstacles, ReachesAGivenDensityExactly) {
  const ObstacleArray array = sample_obstacles({.gap = 0.2, .diameter = 0.3, .density = 0.35, .box = 50}, 1);
  EXPECT_EQ(array.obstacles().size(), 875u);
}

TEST(SampleObstacles, PlacesADilutedArrayUniformly) {
  // Counts in the four quarters of a box: chi-squared with 3 degrees of freedom, summed over 20 seeds, stays
  // below the 99.9 % quantile of 60 degrees, 99.6. (Repulsion only makes counts more even.)
  double chi2 = 0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const ObstacleArray array =
        sample_obstacles({.gap = 0.2, .diameter = 0.3, .density = 0.1, .box = 40}, seed);
    double counts[4] = {};
    for (const Obstacle& o : array.obstacles()) ++counts[(o.x < 20) + 2 * (o.y < 20)];
    for (const double count : counts) chi2 += (count - 40) * (count - 40) / 40;
  }
  EXPECT_LT(chi2, 99.6);
}

TEST(SampleObstacles, RefusesADensityThatDoesNotFit) {
  try {
    sample_obstacles({.gap = 0.2, .diameter = 0.3, .density = 5, .box = 20}, 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("obstacle-density=5"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("saturated"), std::string::npos);
  }
}

TEST(SampleObstacles, DependsOnTheSeedAlone) {
  const ObstacleParameters parameters{.gap = 0.2, .diameter = 0.3, .density = {}, .box = 20};
  const ObstacleArray first = sample_obstacles(parameters, 7);
  const ObstacleArray again = sample_obstacles(parameters, 7);
  const ObstacleArray other = sample_obstacles(parameters, 8);
  ASSERT_EQ(first.obstacles().size(), again.obstacles().size());
  for (std::size_t i = 0; i < first.obstacles().size(); ++i) {
    EXPECT_EQ(first.obstacles()[i].x, again.obstacles()[i].x);
    EXPECT_EQ(first.obstacles()[i].y, again.obstacles()[i].y);
  }
  EXPECT_NE(first.obstacles()[0].x, other.obstacles()[0].x);
}

TEST(ObstacleArray, GathersWhatBruteForceFinds) {
  const double box = 12.5;
  const ObstacleArray array = sample_obstacles({.gap = 0.4, .diameter = 0.3, .density = {}, .box = box}, 2);
  const ObstacleArray::Window window{11, 0.5, -0.6, 2.7, -1.1, 0.9, 0.4};
  std::vector<Obstacle> found;
  array.gather(window, found);
  std::size_t expected = 0;
  for (const Obstacle& o : array.obstacles())
    for (int i = -2; i <= 2; ++i)
      for (int j = -2; j <= 2; ++j) {
        const double x = o.x - window.origin_x + i * box;
        const double y = o.y - window.origin_y + j * box;
        const double margin = window.margin + o.radius;
        expected += x >= -0.6 - margin && x <= 2.7 + margin && y >= -1.1 - margin && y <= 0.9 + margin;
      }
  EXPECT_EQ(found.size(), expected);
  EXPECT_GT(expected, 10u);
}

TEST(ObstacleArray, SeesOverlapsOfMixedSizes) {
  EXPECT_NEAR(ObstacleArray(20, {{1, 1, 0.5}, {19.5, 1, 0.8}}).smallest_gap(), 0.2, 1e-12);
  EXPECT_NEAR(ObstacleArray(20, {{1, 1, 0.5}, {1.2, 1, 0.4}}).smallest_gap(), -0.7, 1e-12);
  EXPECT_TRUE(std::isinf(ObstacleArray(20, {{1, 1, 0.5}}).smallest_gap()));
}

TEST(ObstacleArray, RefusesImpossibleCircles) {
  EXPECT_THROW(ObstacleArray(20, {{1, 1, 0}}), Error);
  EXPECT_THROW(ObstacleArray(20, {{NAN, 1, 0.1}}), Error);
}

}  // namespace
}  // namespace clog

#include "clog/core/world/jamming.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <ostream>

#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {
namespace {

struct Geometry {
  double gap, diameter, spread, box;
  int num_seeds;

  ObstacleParameters obstacles(ObstacleDensity density = {}) const {
    return {.gap = gap, .diameter = diameter, .diameter_spread = spread, .density = density, .box = box};
  }
};
void PrintTo(const Geometry& geometry, std::ostream* out) {
  *out << "gap " << geometry.gap << ", diameter " << geometry.diameter << ", spread " << geometry.spread
       << ", box " << geometry.box;
}

class LargestDensity : public testing::TestWithParam<Geometry> {};

TEST_P(LargestDensity, IsReachedByEverySeed) {
  const Geometry& geometry = GetParam();
  const double most = largest_density(geometry.obstacles()) * geometry.box * geometry.box;
  EXPECT_GE(std::llround(most), 1);
  for (int seed = 1; seed <= geometry.num_seeds; ++seed)
    ASSERT_GE(static_cast<double>(sample_obstacles(geometry.obstacles(), seed).obstacles().size()),
              std::round(most))
        << "seed " << seed;
}

TEST_P(LargestDensity, IsWhatResolveTakes) {
  RunParameters run;
  const double largest = largest_density(GetParam().obstacles());
  run.obstacles = GetParam().obstacles(largest);
  EXPECT_NO_THROW(resolve(run));
  EXPECT_EQ(static_cast<double>(sample_obstacles(run.obstacles, 1).obstacles().size()),
            std::round(largest * run.obstacles.box * run.obstacles.box));
  run.obstacles.density = 1.0001 * largest;
  EXPECT_THROW(resolve(run), Error);
}

INSTANTIATE_TEST_SUITE_P(Geometries, LargestDensity,
                         testing::Values(Geometry{0.2, 0.3, 0, 5, 2000}, Geometry{0.2, 0.3, 0, 20, 200},
                                         Geometry{0.2, 0.3, 0, 100, 5}, Geometry{1, 1, 0, 5, 10000},
                                         Geometry{0.3, 2.2, 0, 5, 10000}, Geometry{1, 6, 0, 17, 10000},
                                         Geometry{0.2, 0.3, 0.1, 5, 1000}, Geometry{0.2, 0.3, 0.5, 5, 500},
                                         Geometry{0.2, 0.3, 0.9, 5, 500}, Geometry{0.5, 2.5, 0.79, 10, 1000},
                                         Geometry{0.2, 0.3, 0.5, 60, 3}));

TEST(LargestDensity, LiesEightToTenStandardDeviationsBelowTheMean) {
  // In such small boxes the number of obstacles fluctuates. From 400 seeds, the standard deviation of this
  // number has an error of 4 %.
  for (const Geometry& geometry : {Geometry{0.2, 0.3, 0, 10, 400}, Geometry{0.2, 0.3, 0.3, 10, 400},
                                   Geometry{0.2, 0.3, 0.9, 10, 400}, Geometry{0.5, 2.5, 0.79, 30, 400}}) {
    double sum = 0, squares = 0;
    for (int seed = 1; seed <= geometry.num_seeds; ++seed) {
      const auto number =
          static_cast<double>(sample_obstacles(geometry.obstacles(), seed).obstacles().size());
      sum += number;
      squares += number * number;
    }
    const double mean = sum / geometry.num_seeds;
    const double deviation = std::sqrt(squares / geometry.num_seeds - mean * mean);
    const double below = mean - largest_density(geometry.obstacles()) * geometry.box * geometry.box;
    EXPECT_GT(below / deviation, 7.5) << testing::PrintToString(geometry);
    EXPECT_LT(below / deviation, 10) << testing::PrintToString(geometry);
  }
}

/// Compares the density that resolve() computes for a share of the saturated density with the number of
/// obstacles in saturated arrays, multiplied by this share.
TEST(ShareOfSaturated, IsThatOfTheMeanOfSaturatedArrays) {
  for (const Geometry& geometry :
       {Geometry{0.2, 0.3, 0, 40, 20}, Geometry{0.5, 0.3, 0, 60, 20}, Geometry{0.2, 0.3, 0.5, 40, 20}}) {
    double number = 0;
    for (int seed = 1; seed <= geometry.num_seeds; ++seed)
      number += static_cast<double>(sample_obstacles(geometry.obstacles(), seed).obstacles().size());
    const double saturated = number / geometry.num_seeds / (geometry.box * geometry.box);
    RunParameters run;
    run.obstacles = geometry.obstacles(ObstacleDensity::share_of_saturated(0.25));
    const std::optional<double> density = resolve(run).obstacles.density.per_area;
    ASSERT_TRUE(density);
    EXPECT_NEAR(*density, 0.25 * saturated, 0.01 * *density) << testing::PrintToString(geometry);
    const auto sampled = static_cast<double>(sample_obstacles(run.obstacles, 3).obstacles().size());
    EXPECT_EQ(sampled, std::round(*density * geometry.box * geometry.box));
  }
}

TEST(LargestDensity, ComesCloseToTheJammingLimitInALargeBox) {
  const double jammed = saturated_density(0.3, 0.2);
  EXPECT_GT(largest_density({.gap = 0.2, .diameter = 0.3, .density = {}, .box = 500}), 0.997 * jammed);
  EXPECT_LT(largest_density({.gap = 0.2, .diameter = 0.3, .density = {}, .box = 5000}), jammed);
}

}  // namespace
}  // namespace clog

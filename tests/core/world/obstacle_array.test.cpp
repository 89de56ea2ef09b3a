#include "clog/core/world/obstacle_array.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "clog/core/droplet/release.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/instruction_set.hpp"

namespace clog {
namespace {

double brute_force_gap(const ObstacleArray& array) {
  double smallest = 1e9;
  const auto& all = array.obstacles();
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double dx = std::remainder(all[i].x - all[j].x, array.period().along());
      const double dy = std::remainder(all[i].y - all[j].y, array.period().across());
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
  // At the jamming limit, discs of diameter gap + sigma_ob cover 0.547069 of the plane. In boxes of this size
  // the covered fraction scatters by less than 0.001.
  double coverage = 0;
  for (const std::uint32_t seed : {1u, 2u, 3u, 4u}) {
    const ObstacleArray array =
        sample_obstacles({.gap = 0.2, .diameter = 0.3, .density = {}, .box = 100}, seed);
    coverage += static_cast<double>(array.obstacles().size()) / 1e4 * std::numbers::pi / 4 * 0.25 / 4;
  }
  EXPECT_NEAR(coverage, 0.547069, 0.001);
}

/// Expects that there is no room for another obstacle. The sum of diameter and gap is 0.7.
void expect_no_room(const ObstacleArray& array) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> along(0, array.period().along()), across(0, array.period().across());
  for (int i = 0; i < 20000; ++i) {
    std::vector<Obstacle> near;
    array.gather({along(engine), across(engine), 0, 0, 0, 0, 0.6}, near);
    EXPECT_TRUE(std::any_of(near.begin(), near.end(),
                            [](const Obstacle& o) { return std::hypot(o.x, o.y) < 0.7001; }));
  }
}

TEST(SampleObstacles, LeavesNoRoomForOneMoreWhenSaturated) {
  expect_no_room(sample_obstacles({.gap = 0.4, .diameter = 0.3, .density = {}, .box = 30}, 4));
}

/// @param boxes  number of boxes in a row along the flow, each 10 sigma long
ObstacleParameters long_array(int boxes, ObstacleDensity density = {}) {
  return {.gap = 0.4, .diameter = 0.3, .density = density, .box = 10, .boxes = boxes};
}

TEST(SampleObstacles, FillsALongArrayAsASquareOne) {
  const ObstacleArray array = sample_obstacles(long_array(40), 3);
  EXPECT_EQ(array.period().along(), 400);
  EXPECT_EQ(array.period().across(), 10);
  EXPECT_GE(brute_force_gap(array), 0.4);
  EXPECT_DOUBLE_EQ(array.smallest_gap(), brute_force_gap(array));
  // The expected number follows from Feder's coverage. In this array the number of obstacles scatters by 18,
  // which is 0.2 times the square root of the area, divided by the spacing.
  const double expected = 0.547069 * 4000 / (std::numbers::pi / 4 * 0.49);
  EXPECT_NEAR(static_cast<double>(array.obstacles().size()), expected, 5 * 18);
  expect_no_room(array);
  EXPECT_EQ(sample_obstacles(long_array(40, 0.35), 3).obstacles().size(), 1400u);
}

TEST(SampleObstacles, DoesNotRepeatItselfWithinALongArray) {
  const ObstacleArray array = sample_obstacles(long_array(3), 5);
  std::vector<std::vector<double>> heights(3);
  for (const Obstacle& obstacle : array.obstacles())
    heights[static_cast<int>(obstacle.x / 10)].push_back(obstacle.y);
  for (int box = 0; box < 3; ++box) {
    EXPECT_GT(heights[box].size(), 90u);
    EXPECT_NE(heights[box], heights[(box + 1) % 3]);
  }
}

TEST(SampleObstacles, ReachesAGivenDensityExactly) {
  const ObstacleArray array = sample_obstacles({.gap = 0.2, .diameter = 0.3, .density = 0.35, .box = 50}, 1);
  EXPECT_EQ(array.obstacles().size(), 875u);
}

TEST(SampleObstacles, TheSmallestGapDoesNotFixTheDensity) {
  // The article states only that all gaps are wider than w_ob. Both arrays fulfil this rule, although one of
  // them is ten times as dense as the other.
  const ObstacleParameters sparse{.gap = 0.2, .diameter = 0.3, .density = 0.25, .box = 40};
  const ObstacleParameters saturated{.gap = 0.2, .diameter = 0.3, .density = {}, .box = 40};
  const ObstacleArray few = sample_obstacles(sparse, 1), many = sample_obstacles(saturated, 1);
  EXPECT_GE(few.smallest_gap(), 0.2 - 1e-12);
  EXPECT_GE(many.smallest_gap(), 0.2 - 1e-12);
  EXPECT_GT(many.obstacles().size(), 10 * few.obstacles().size());
}

TEST(SampleObstacles, PlacesADilutedArrayUniformly) {
  // The counts in the four quarters of a box give a chi-squared with 3 degrees of freedom. The sum over 20
  // seeds must stay below 99.6, which is the 99.9 % quantile for 60 degrees of freedom. Repulsion between
  // obstacles can only make the counts more even.
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

/// An FNV hash of all bits, which also depends on the order of the obstacles.
std::uint64_t digest(const ObstacleArray& array) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const Obstacle& obstacle : array.obstacles())
    for (const double value : {obstacle.x, obstacle.y, obstacle.radius})
      hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3u;
  return hash;
}

TEST(SampleObstacles, GivesDiscsOfOneSizeThatNeverChange) {
  // These digests were recorded with the sampler that adds discs square by square. Replace them only in a
  // change that also alters the course of runs.
  EXPECT_EQ(digest(sample_obstacles({.gap = 0.4, .density = {}, .box = 30}, 4)), 0xea87e7a8c4585524u);
  EXPECT_EQ(digest(sample_obstacles({.gap = 0.2, .density = 0.35, .box = 50}, 1)), 0x10fc226cc1015f64u);
  EXPECT_EQ(digest(sample_obstacles({.gap = 1.1, .density = {}, .box = 17.3}, 11)), 0x9241ec7695805bf0u);
}

ObstacleParameters mixture(double spread, double box, ObstacleDensity density = {}) {
  return {.gap = 0.2, .diameter = 0.3, .diameter_spread = spread, .density = density, .box = box};
}

TEST(SampleObstacles, KeepsTheGapBetweenSurfacesOfAMixture) {
  for (const double spread : {0.01, 0.3, 0.9})
    for (const double box : {5.0, 17.3}) {
      const ObstacleArray array = sample_obstacles(mixture(spread, box), 5);
      EXPECT_GE(brute_force_gap(array), 0.2) << spread;
      EXPECT_NEAR(brute_force_gap(array), 0.2, 0.02) << spread;
      for (const Obstacle& obstacle : array.obstacles())
        EXPECT_NEAR(2 * obstacle.radius, 0.3, 0.3 * spread + 1e-7) << spread;
    }
}

TEST(SampleObstacles, LeavesNoRoomForEvenTheSmallestOfAMixture) {
  const double spread = 0.6;
  const double reach = 0.3 / 2 * (1 - spread) + 0.2;
  const ObstacleArray array = sample_obstacles(mixture(spread, 10), 3);
  constexpr int side = 800;
  std::vector<Obstacle> near;
  int num_free = 0;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      near.clear();
      array.gather({10.0 * column / side, 10.0 * row / side, 0, 0, 0, 0, reach}, near);
      num_free += std::none_of(near.begin(), near.end(), [&](const Obstacle& o) {
        return std::hypot(o.x, o.y) - o.radius < reach * 1.0001;
      });
    }
  EXPECT_EQ(num_free, 0);
}

TEST(SampleObstacles, DrawsTheDiametersOfADilutedMixtureUniformly) {
  // The counts of 4000 diameters in ten bins give a chi-squared with 9 degrees of freedom. The chi-squared
  // must stay below its 99.9 % quantile.
  double counts[10] = {};
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    const ObstacleArray array = sample_obstacles(mixture(0.5, 50, 0.16), seed);
    for (const Obstacle& obstacle : array.obstacles())
      ++counts[std::clamp(static_cast<int>((2 * obstacle.radius - 0.15) / 0.03), 0, 9)];
  }
  double chi2 = 0;
  for (const double count : counts) chi2 += (count - 400) * (count - 400) / 400;
  EXPECT_LT(chi2, 27.9);
}

/// Adds discs at random places one after the other, as random sequential addition is defined. A disc without
/// room is dropped. @return the first `count` discs that have room
ObstacleArray one_by_one(const ObstacleParameters& parameters, std::size_t count, std::uint32_t seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> place(0, parameters.box);
  std::uniform_real_distribution<double> diameter(parameters.smallest_diameter(),
                                                  parameters.largest_diameter());
  std::vector<Obstacle> stayed;
  while (stayed.size() < count) {
    const Obstacle arrives{place(engine), place(engine), diameter(engine) / 2};
    const bool has_room = std::none_of(stayed.begin(), stayed.end(), [&](const Obstacle& other) {
      const double dx = std::remainder(arrives.x - other.x, parameters.box);
      const double dy = std::remainder(arrives.y - other.y, parameters.box);
      return std::hypot(dx, dy) < arrives.radius + other.radius + parameters.gap;
    });
    if (has_room) stayed.push_back(arrives);
  }
  return {parameters.box, std::move(stayed)};
}

double mean_diameter(const ObstacleArray& array) {
  double sum = 0;
  for (const Obstacle& obstacle : array.obstacles()) sum += 2 * obstacle.radius;
  return sum / static_cast<double>(array.obstacles().size());
}

/// The number of pairs with a gap of at most `widest` between their surfaces, divided by the number of
/// obstacles.
double close_pairs(const ObstacleArray& array, double widest) {
  int num_pairs = 0;
  const auto& all = array.obstacles();
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double dx = std::remainder(all[i].x - all[j].x, array.period().box);
      const double dy = std::remainder(all[i].y - all[j].y, array.period().box);
      num_pairs += std::hypot(dx, dy) - all[i].radius - all[j].radius <= widest;
    }
  return num_pairs / static_cast<double>(all.size());
}

TEST(SampleObstacles, PacksLikeDiscsThatArriveOneByOne) {
  // Compares how many neighbours are at nearly the smallest distance. The arrays are close to saturation,
  // which is at 2.79 per sigma^2.
  const ObstacleParameters parameters{.gap = 0.2, .diameter = 0.3, .density = 2.25, .box = 6};
  constexpr int num_arrays = 250;
  double difference = 0;
  double scatter = 0;
  double expected = 0;
  for (std::uint32_t seed = 1; seed <= num_arrays; ++seed) {
    const double exact = close_pairs(one_by_one(parameters, 81, seed), 0.22);
    const double found = close_pairs(sample_obstacles(parameters, seed), 0.22);
    expected += exact / num_arrays;
    difference += (found - exact) / num_arrays;
    scatter += (found - exact) * (found - exact) / num_arrays;
  }
  EXPECT_LT(std::abs(difference), 3.5 * std::sqrt(scatter / num_arrays));
  EXPECT_LT(3.5 * std::sqrt(scatter / num_arrays), 0.1 * expected) << "sharp enough to see a wrong process";
}

TEST(SampleObstacles, MixesLikeDiscsThatArriveOneByOne) {
  // Close to saturation (4.1 per sigma^2 for this mixture), there is no room for most of the large discs.
  const ObstacleParameters parameters = mixture(0.5, 6, 3.2);
  constexpr int num_arrays = 100;
  double difference = 0;
  double scatter = 0;
  for (std::uint32_t seed = 1; seed <= num_arrays; ++seed) {
    const ObstacleArray array = sample_obstacles(parameters, seed);
    const double mean = mean_diameter(array);
    const double expected = mean_diameter(one_by_one(parameters, array.obstacles().size(), seed));
    EXPECT_LT(expected, 0.28) << "the large ones find no room";
    difference += (mean - expected) / num_arrays;
    scatter += (mean - expected) * (mean - expected) / num_arrays;
  }
  EXPECT_LT(std::abs(difference), 3.5 * std::sqrt(scatter / num_arrays));
  EXPECT_LT(std::sqrt(scatter / num_arrays), 1e-3) << "sharp enough to see a wrong mixture";
}

TEST(SampleObstacles, DependsOnTheSeedAlone) {
  for (const double spread : {0.0, 0.5}) {
    const std::uint64_t first = digest(sample_obstacles(mixture(spread, 20), 7));
    EXPECT_EQ(first, digest(sample_obstacles(mixture(spread, 20), 7)));
    EXPECT_NE(first, digest(sample_obstacles(mixture(spread, 20), 8)));
  }
}

TEST(SampleObstacles, DoesNotDependOnTheInstructionSet) {
  const auto digests_with = [](const std::string& set) {
    use_instruction_set(set);
    const std::pair both{digest(sample_obstacles(mixture(0, 50), 3)),
                         digest(sample_obstacles(mixture(0.5, 20), 7))};
    use_instruction_set("auto");
    return both;
  };
  for (const std::string& set : instruction_sets()) EXPECT_EQ(digests_with(set), digests_with("auto")) << set;
}

TEST(SampleObstacles, RefusesADensityThatDoesNotFitAndSaysWhatDoes) {
  for (const double spread : {0.0, 0.5}) try {
      sample_obstacles(mixture(spread, 20, 6), 1);
      FAIL() << spread;
    } catch (const Error& error) {
      const std::string message = error.what();
      for (const char* words :
           {"obstacle-density=6", "saturated", spread > 0 ? "no more than 4.0" : "no more than 2.",
            spread > 0 ? "of diameter 0.15 to 0.45 fit" : "of diameter 0.3 fit"})
        EXPECT_NE(message.find(words), std::string::npos) << message;
    }
}

class Gathering : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Boxes, Gathering, testing::Values(1, 3));

TEST_P(Gathering, FindsWhatBruteForceFinds) {
  const ObstacleArray array =
      sample_obstacles({.gap = 0.4, .diameter = 0.3, .density = {}, .box = 12.5, .boxes = GetParam()}, 2);
  const Period& period = array.period();
  // Along the flow, the window crosses the end of the period. Across the flow, it crosses the beginning.
  const ObstacleArray::Window window{period.along() - 1.5, 0.5, -0.6, 2.7, -1.1, 0.9, 0.4};
  std::vector<Obstacle> found;
  array.gather(window, found);
  std::size_t expected = 0;
  for (const Obstacle& o : array.obstacles())
    for (int i = -2; i <= 2; ++i)
      for (int j = -2; j <= 2; ++j) {
        const double x = o.x - window.origin_x + i * period.along();
        const double y = o.y - window.origin_y + j * period.across();
        const double margin = window.margin + o.radius;
        expected += x >= -0.6 - margin && x <= 2.7 + margin && y >= -1.1 - margin && y <= 0.9 + margin;
      }
  EXPECT_EQ(found.size(), expected);
  EXPECT_GT(expected, 10u);
}

TEST(ObstacleArray, SeesOverlapsOfMixedSizes) {
  EXPECT_NEAR(ObstacleArray(20, {{1, 1, 0.5}, {19.5, 1, 0.8}}).smallest_gap(), 0.2, 1e-12);
  EXPECT_NEAR(ObstacleArray(20, {{1, 1, 0.5}, {1.6, 1, 0.4}}).smallest_gap(), -0.3, 1e-12);
  EXPECT_NEAR(ObstacleArray(20, {{1, 1, 0.5}}).smallest_gap(), 19, 1e-12) << "to its own periodic image";
  EXPECT_TRUE(std::isinf(ObstacleArray(20, {}).smallest_gap()));
}

TEST(ObstacleArray, CirclesWithACentreInEachOtherAreOnePost) {
  // A row of circles crosses the border of the period. Another circle overlaps the last circle of the row,
  // but has no centre inside it. Two circles are copies of each other.
  const ObstacleArray array(
      10, {{9.8, 5, 0.3}, {0, 5, 0.3}, {0.2, 5, 0.3}, {0.6, 5, 0.3}, {5, 5, 0.3}, {5, 5, 0.3}});
  const std::vector<std::uint32_t> posts = array.posts();
  const auto post_at = [&](double x, int copy = 0) {
    for (std::size_t i = 0; i < posts.size(); ++i)
      if (array.obstacles()[i].x == x && copy-- == 0) return posts[i];
    throw std::out_of_range("no such circle");
  };
  EXPECT_EQ(post_at(9.8), post_at(0));
  EXPECT_EQ(post_at(0), post_at(0.2));
  EXPECT_NE(post_at(0.2), post_at(0.6));
  EXPECT_NE(post_at(5), post_at(5, 1));
  EXPECT_NEAR(array.smallest_gap(), -0.6, 1e-12) << "of the two copies";
  EXPECT_NEAR(ObstacleArray(10, {{1, 5, 0.3}, {1.2, 5, 0.3}, {1, 5, 0.3}}).smallest_gap(), -0.6, 1e-12)
      << "of two copies in one post";
  // Gaps within a post do not count, but a gap between a post and its own periodic image does.
  EXPECT_NEAR(ObstacleArray(10, {{1, 5, 0.3}, {1.2, 5, 0.3}, {1.4, 5, 0.3}, {1.65, 5, 0.3}, {4, 5, 0.3}})
                  .smallest_gap(),
              1.75, 1e-12);
  EXPECT_NEAR(ObstacleArray(2, {{0.4, 1, 0.3}, {0.6, 1, 0.3}, {0.8, 1, 0.3}}).smallest_gap(), 1, 1e-12);
}

/// Circles in a row along an arc.
void add_arc(std::vector<Obstacle>& circles, const Eigen::Array2d& centre, double radius, double from,
             double to) {
  constexpr double thickness = 0.1;
  for (double angle = from; angle < to; angle += thickness / radius)
    circles.push_back(
        {centre[0] + radius * std::cos(angle), centre[1] + radius * std::sin(angle), thickness});
}

TEST(ObstacleArray, KnowsTheGapOfAWidePostToItsOwnImage) {
  for (const double radius : {1.0, 2.8, 3.2, 4.0, 5.2, 5.6}) {
    std::vector<Obstacle> circles;
    add_arc(circles, {6, 6}, radius, 0, 2 * std::numbers::pi);
    // The outermost circles need not be on the axes exactly.
    EXPECT_NEAR(ObstacleArray(12, circles).smallest_gap(), 12 - 2 * (radius + 0.1), 0.01) << radius;
    for (Obstacle& circle : circles) circle.x += 6;  // across the border
    EXPECT_NEAR(ObstacleArray(12, circles).smallest_gap(), 12 - 2 * (radius + 0.1), 0.01) << radius;
  }
}

TEST(ObstacleArray, FindsPlacesWithinAPost) {
  constexpr double pi = std::numbers::pi;
  std::vector<Obstacle> circles;
  const Eigen::Array2d ring{9, 1}, open{4, 6}, half{3, 0};
  add_arc(circles, ring, 2, 0, 2 * pi);      // The ring crosses two borders of the period.
  add_arc(circles, open, 1.5, 0.2, 2 * pi);  // This ring has an opening.
  add_arc(circles, half, 1, -0.05, pi);      // The half ring stands on the lower wall, if there is one.
  for (double x = 0; x < 10; x += 0.15) circles.push_back({x, 8.5, 0.1});  // A row from border to border.
  const ObstacleArray periodic(10, circles);
  Period beside_walls(10);
  beside_walls.beside = 3;
  const ObstacleArray between_walls(beside_walls, circles,
                                    {{.tip = {0, 0}, .axis = {0, -1}}, {.tip = {0, 10}, .axis = {0, 1}}});
  const auto is_in_ring = [&](const Eigen::Array2d& place, double period) {
    const Eigen::Array2d way = place - ring;
    return std::hypot(std::remainder(way[0], 10), period > 0 ? std::remainder(way[1], period) : way[1]) < 2;
  };
  std::mt19937 random(5);
  std::uniform_real_distribution<double> along(0, 10);
  int num_tried = 0, num_within = 0;
  while (num_tried < 500) {
    const Eigen::Array2d place{along(random), along(random)};
    if (clearance(periodic, place[0], place[1], 1) <= 0) continue;
    ++num_tried;
    ASSERT_EQ(periodic.is_within_post(place), is_in_ring(place, 10)) << place.transpose();
    if (clearance(between_walls, place[0], place[1], 1) <= 0) continue;
    const bool is_in_pocket = (place - half).matrix().norm() < 1;
    // A wall cuts through the ring. The part in the device and the wall still enclose a place.
    ASSERT_EQ(between_walls.is_within_post(place), is_in_ring(place, 0) || is_in_pocket) << place.transpose();
    num_within += is_in_ring(place, 0) || is_in_pocket;
  }
  EXPECT_GT(num_within, 20);
}

TEST(ObstacleArray, FindsPostsAmongAFewCircles) {
  // The third circle overlaps only the second. The fourth circle joins the first two, and the last one is a
  // copy of the fourth.
  const std::vector<Obstacle> circles{
      {1, 1, 0.2}, {1.3, 1, 0.2}, {1.55, 1, 0.2}, {1.15, 1, 0.2}, {1.15, 1, 0.2}};
  EXPECT_EQ(posts_among(circles), (std::vector<int>{0, 0, 1, 0, 0}));
  EXPECT_EQ(posts_among(std::vector<Obstacle>{{1, 1, 0.2}, {1, 1, 0.2}}), (std::vector<int>{0, 1}))
      << "a copy";
  // A small circle belongs to a large circle if its centre is inside the large circle.
  EXPECT_EQ(posts_among(std::vector<Obstacle>{{1, 1, 0.1}, {1.4, 1, 0.5}}), (std::vector<int>{0, 0}));
  EXPECT_TRUE(posts_among({}).empty());
}

TEST(ObstacleArray, NamesItsClosestPair) {
  const auto pair = ObstacleArray(20, {{5, 5, 1}, {19.5, 1, 0.8}, {1, 1, 0.5}, {9, 5, 1}}).closest_pair();
  EXPECT_NEAR(pair.gap, 0.2, 1e-12);
  EXPECT_EQ(std::min(pair.first.x, pair.second.x), 1);
  EXPECT_EQ(std::max(pair.first.x, pair.second.x), 19.5);
}

TEST(ObstacleArray, RefusesImpossibleCircles) {
  EXPECT_THROW(ObstacleArray(20, {{1, 1, 0}}), Error);
  EXPECT_THROW(ObstacleArray(20, {{NAN, 1, 0.1}}), Error);
}

}  // namespace
}  // namespace clog

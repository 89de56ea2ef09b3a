#include "clog/fit/length_ratio.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace clog::fit {
namespace {

/// Draws pairs of distances by the law of Marshall and Olkin. Some places hold both droplets of a pair, and
/// other places hold only one of them. Both distances of a pair follow exponential laws.
std::vector<Pair> drawn_pairs(std::mt19937& engine, int number, double share, double ratio) {
  const double common_rate = share / std::max(1.0, ratio);
  const auto draw = [&](double rate) {
    if (rate <= 0) return std::numeric_limits<double>::infinity();
    return std::exponential_distribution<double>(rate)(engine);
  };
  std::vector<Pair> pairs;
  for (int i = 0; i < number; ++i) {
    const double both = draw(common_rate);
    const double here = std::min(both, draw(1 / ratio - common_rate));
    const double there = std::min(both, draw(1 - common_rate));
    pairs.push_back({{here, true}, {there, true}, here == there});
  }
  return pairs;
}

LengthRatio fit_pairs(const std::vector<Pair>& pairs) {
  std::vector<Observation> here, there;
  for (const Pair& pair : pairs) {
    here.push_back(pair.here);
    there.push_back(pair.there);
  }
  return fit_length_ratio(here, there, pairs);
}

TEST(LengthRatio, IsInverseWhenTheSidesAreExchanged) {
  std::mt19937 engine(1);
  std::vector<Pair> pairs = drawn_pairs(engine, 400, 0.6, 1.5);
  const LengthRatio ratio = fit_pairs(pairs);
  for (Pair& pair : pairs) std::swap(pair.here, pair.there);
  const LengthRatio inverse = fit_pairs(pairs);
  EXPECT_TRUE(ratio.is_paired);
  EXPECT_NEAR(ratio.ratio * inverse.ratio, 1, 1e-12);
  EXPECT_NEAR(ratio.paired.lower * inverse.paired.upper, 1, 1e-12);
  EXPECT_NEAR(ratio.unpaired.lower * inverse.unpaired.upper, 1, 1e-9);
  EXPECT_NEAR(ratio.gain, inverse.gain, 1e-9);
}

TEST(LengthRatio, ScalesWithTheWaysOfOneSide) {
  std::mt19937 engine(2);
  std::vector<Pair> pairs = drawn_pairs(engine, 30, 0.5, 1);
  const LengthRatio before = fit_pairs(pairs);
  for (Pair& pair : pairs) pair.here.distance *= 3;
  const LengthRatio after = fit_pairs(pairs);
  EXPECT_NEAR(after.ratio, 3 * before.ratio, 1e-9);
  EXPECT_NEAR(after.interval.upper, 3 * before.interval.upper, 1e-9);
}

TEST(LengthRatio, IsExactOnPaperForOneClogEach) {
  // With 2 d + 1 = 3 degrees of freedom on both sides, the 97.5 % quantile of F(3, 3) is 15.4392 (from
  // tables).
  const std::vector<Observation> here = {{4, true}, {4, false}}, there = {{1, true}, {3, false}};
  const LengthRatio ratio = fit_length_ratio(here, there, {});
  EXPECT_DOUBLE_EQ(ratio.ratio, 2);
  EXPECT_NEAR(ratio.interval.lower, 2 / 15.4392, 1e-5);
  EXPECT_NEAR(ratio.interval.upper, 2 * 15.4392, 1e-3);
  EXPECT_FALSE(ratio.is_paired);
}

TEST(LengthRatio, TakesNoPairsWhereFewAreUnlike) {
  std::mt19937 engine(3);
  std::vector<Pair> pairs = drawn_pairs(engine, 30, 0.9, 1);
  const LengthRatio ratio = fit_pairs(pairs);
  ASSERT_LT(ratio.num_unlike, 10);
  EXPECT_GT(ratio.correlation, 0.5);
  EXPECT_FALSE(ratio.is_paired);
  EXPECT_EQ(ratio.interval.lower, ratio.unpaired.lower);
}

TEST(LengthRatio, IsNotKnownWithoutClogs) {
  const std::vector<Observation> none = {{4, false}}, one = {{1, true}};
  const std::vector<Pair> pairs = {{none[0], one[0], false}};
  const LengthRatio ratio = fit_length_ratio(none, one, pairs);
  EXPECT_TRUE(std::isnan(ratio.interval.lower));
  EXPECT_TRUE(std::isnan(ratio.gain));
  EXPECT_FALSE(ratio.is_paired);
}

/// The fraction of sweeps whose interval contains the true ratio, and the fraction of sweeps whose interval
/// comes from pairs.
struct Coverage {
  double covered = 0, paired = 0;
};
Coverage coverage(int num_pairs, double share) {
  constexpr int repetitions = 2000;
  constexpr double ratio = 1.3;
  std::mt19937 engine(7);
  Coverage found;
  for (int i = 0; i < repetitions; ++i) {
    const LengthRatio fit = fit_pairs(drawn_pairs(engine, num_pairs, share, ratio));
    found.covered +=
        (fit.interval.lower <= ratio && ratio <= fit.interval.upper) / static_cast<double>(repetitions);
    found.paired += fit.is_paired / static_cast<double>(repetitions);
  }
  return found;
}

TEST(LengthRatio, CoversTheTruthAsOftenAsItClaims) {
  for (const double share : {0.0, 0.5, 0.8}) {
    const Coverage found = coverage(40, share);
    RecordProperty("covered", std::to_string(found.covered));
    EXPECT_GT(found.covered, 0.92) << share;
    EXPECT_LT(found.covered, 0.99) << share;  // an interval that does not use the pairs would be too wide
    EXPECT_GE(found.paired, share == 0.8 ? 0.8 : 0) << share;
    EXPECT_LE(found.paired, share == 0 ? 0.06 : 1) << share;
  }
}

TEST(LengthRatio, FindsHowMuchPairsGain) {
  std::mt19937 engine(5);
  EXPECT_NEAR(fit_pairs(drawn_pairs(engine, 4000, 0, 1)).gain, 1, 0.05);
  // If two equal laws have a share s of the clogs in common, their correlation is s/(2 - s) (Marshall and
  // Olkin 1967).
  const double correlation = 0.8 / 1.2;
  const LengthRatio ratio = fit_pairs(drawn_pairs(engine, 4000, 0.8, 1));
  EXPECT_NEAR(ratio.correlation, correlation, 0.04);
  EXPECT_NEAR(ratio.gain, 1 / std::sqrt(1 - correlation), 0.1);
}

}  // namespace
}  // namespace clog::fit

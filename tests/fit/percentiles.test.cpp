#include "clog/fit/percentiles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace clog::fit {
namespace {

std::vector<double> resampled_means(const std::vector<double>& sample) {
  std::mt19937_64 engine(7);
  std::uniform_int_distribution<std::size_t> draw(0, sample.size() - 1);
  std::vector<double> means(20000);
  for (double& mean : means) {
    for (std::size_t i = 0; i < sample.size(); ++i) mean += sample[draw(engine)];
    mean /= static_cast<double>(sample.size());
  }
  return means;
}

/// For the mean of a symmetric sample, expanded percentiles are those of Student's t.
TEST(PercentileInterval, OfAMeanIsThatOfStudent) {
  // From R: t.test(x)$conf.int of these numbers, and qt(0.975, 11) = 2.200985.
  const std::vector<double> sample = {-5.5, -4.5, -3.5, -2.5, -1.5, -0.5, 0.5, 1.5, 2.5, 3.5, 4.5, 5.5};
  const double half = 2.200985 * std::sqrt(13.0) / std::sqrt(12.0);
  const Interval found = percentile_interval(resampled_means(sample), sample.size(), 0.95);
  EXPECT_NEAR(found.lower, -half, 0.06 * half);
  EXPECT_NEAR(found.upper, half, 0.06 * half);
}

TEST(PercentileInterval, IsUnknownWithoutVariationAndForTooFewValues) {
  EXPECT_TRUE(std::isnan(percentile_interval(std::vector<double>(2000, 3), 12, 0.95).lower));
  EXPECT_TRUE(std::isnan(percentile_interval({1, 2}, 1, 0.95).lower));
  std::vector<double> values(2000);
  std::iota(values.begin(), values.end(), 0.0);
  EXPECT_TRUE(std::isnan(percentile_interval(values, 3, 0.95).lower));
  EXPECT_FALSE(std::isnan(percentile_interval(values, 30, 0.95).lower));
}

}  // namespace
}  // namespace clog::fit

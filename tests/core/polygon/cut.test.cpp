#include "clog/core/polygon/cut.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "clog/core/droplet/shape.hpp"

namespace clog {
namespace {

using Eigen::Array2d;
using std::numbers::pi;

Array2d mean(const Eigen::ArrayXd& all) {
  const Eigen::Index n = all.size() / 2;
  return {all.head(n).mean(), all.tail(n).mean()};
}

/// A moving and turning droplet with a waist, two unequal lobes and irregular sides.
MovingPolygon random_droplet(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  const int n = 100 + static_cast<int>(50 * any(random));
  const double turn = pi * any(random), lobe = 0.1 * any(random);
  constexpr int most_waves = 7;
  std::array<double, most_waves + 1> cosines{}, sines{};
  for (int k = 3; k <= most_waves; ++k) cosines[k] = 0.01 * any(random), sines[k] = 0.01 * any(random);
  MovingPolygon droplet{Eigen::ArrayXd(2 * n), Eigen::ArrayXd(2 * n)};
  for (int i = 0; i < n; ++i) {
    const double t = 2 * pi * i / n;
    double radius = 0.5 + 0.44 * std::cos(2 * t) + lobe * std::cos(t);
    for (int k = 3; k <= most_waves; ++k) radius += cosines[k] * std::cos(k * t) + sines[k] * std::sin(k * t);
    droplet.position[i] = 3 + radius * std::cos(t + turn);
    droplet.position[n + i] = -2 + radius * std::sin(t + turn);
    droplet.velocity[i] = 0.03 - 0.1 * droplet.position[n + i] + 0.01 * any(random);
    droplet.velocity[n + i] = 0.1 * droplet.position[i] + 0.01 * any(random);
  }
  return droplet;
}

constexpr std::uint32_t num_droplets = 200;

TEST(Cut, KeepsAreaCentroidAndMomentum) {
  for (std::uint32_t seed = 1; seed <= num_droplets; ++seed) {
    const MovingPolygon whole = random_droplet(seed);
    const Neck neck = thinnest_neck(whole.position);
    ASSERT_LT(neck.width, 0.5) << seed;
    double area = 0;
    Array2d centroid{0, 0}, momentum{0, 0};
    for (const MovingPolygon& part : cut(whole, neck)) {
      const double share = polygon_shape(part.position).area;
      EXPECT_GT(share, 0.02 * polygon_shape(whole.position).area);
      EXPECT_EQ(num_self_crossings(part.position), 0);
      area += share;
      centroid += share * area_centroid(part.position);
      momentum += share * mean(part.velocity);
    }
    EXPECT_NEAR(area, polygon_shape(whole.position).area, 1e-14) << seed;
    EXPECT_LT((centroid / area - area_centroid(whole.position)).abs().maxCoeff(), 1e-13) << seed;
    EXPECT_LT((momentum / area - mean(whole.velocity)).abs().maxCoeff(), 1e-15) << seed;
  }
}

TEST(Cut, GoesAlongTheNeck) {
  const MovingPolygon whole = random_droplet(7);
  const Neck neck = thinnest_neck(whole.position);
  for (const MovingPolygon& part : cut(whole, neck)) {
    const Eigen::Index n = part.position.size() / 2;
    double nearest = INFINITY;
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Index next = (i + 1) % n;
      nearest = std::min(nearest, std::abs(std::hypot(part.position[next] - part.position[i],
                                                      part.position[n + next] - part.position[n + i]) -
                                           neck.width));
    }
    EXPECT_LT(nearest, 1e-15);
    EXPECT_GT(n, 10);
  }
}

TEST(Cut, AtAVertexHasNoEdgeOfNoLength) {
  MovingPolygon square{Eigen::ArrayXd(8), Eigen::ArrayXd::Zero(8)};
  square.position << 0, 1, 1, 0, 0, 0, 1, 1;
  for (const double place : {0.0, 1.0}) {
    const Neck across{.width = 1, .vertex = 0, .edge = place == 0 ? 2 : 1, .place = place};
    const auto parts = cut(square, across);
    EXPECT_EQ(parts[0].position.size(), 6);
    EXPECT_EQ(parts[1].position.size(), 6);
    EXPECT_EQ(polygon_shape(parts[0].position).area, 0.5);
  }
}

TEST(WithVertices, KeepsAreaCentroidAndMomentum) {
  for (std::uint32_t seed = 1; seed <= num_droplets; ++seed) {
    const MovingPolygon whole = random_droplet(seed);
    const int num_vertices = 32 + static_cast<int>(seed);
    const MovingPolygon spread = with_vertices(whole, num_vertices);
    ASSERT_EQ(spread.position.size(), 2 * num_vertices);
    EXPECT_NEAR(polygon_shape(spread.position).area, polygon_shape(whole.position).area, 1e-14);
    EXPECT_LT((area_centroid(spread.position) - area_centroid(whole.position)).abs().maxCoeff(), 1e-13);
    EXPECT_LT((mean(spread.velocity) - mean(whole.velocity)).abs().maxCoeff(), 1e-15);
  }
}

TEST(WithVertices, OfAPolygonWithEqualEdgesIsThisPolygon) {
  const Eigen::ArrayXd regular = regular_polygon(64, 0.8);
  const MovingPolygon spread = with_vertices({regular, Eigen::ArrayXd::Constant(128, 0.1)}, 64);
  EXPECT_LT((spread.position - regular).abs().maxCoeff(), 1e-13);
  EXPECT_LT((spread.velocity - 0.1).abs().maxCoeff(), 1e-16);
}

}  // namespace
}  // namespace clog

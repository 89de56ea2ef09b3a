#include "clog/core/world/lattice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <set>
#include <vector>

#include "clog/core/run/droplet_run.hpp"
#include "clog/core/run/resolve.hpp"

namespace clog {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// A soft disk that is nearly rigid, among obstacles with room to pass. The spacing is 1.5 sigma, and the
/// obstacles have a diameter of 0.3 sigma.
RunParameters lattice_disk(double angle, std::uint32_t seed = 1, LatticeKind kind = LatticeKind::square) {
  RunParameters run;
  run.model = Model::sp;
  run.wall_stiffness = 10;
  run.time_step = 2e-3;
  run.max_time = 4000;
  run.obstacles.gap = 1.2;
  run.obstacles.box = 120;
  run.obstacles.layout = ObstacleLayout::lattice;
  run.obstacles.lattice = kind;
  run.obstacles.lattice_angle = angle;
  run.seed = seed;
  return resolve(run);
}

/// A lattice of pitch 2 with periods of at most `box`.
ObstacleParameters small_lattice(LatticeKind kind, double angle, double box) {
  RunParameters run;
  run.obstacles.layout = ObstacleLayout::lattice;
  run.obstacles.lattice = kind;
  run.obstacles.lattice_angle = angle;
  run.obstacles.pitch = 2;
  run.obstacles.box = box;
  return resolve(run).obstacles;
}

/// For each post, the distances of the posts within 3 sigma in increasing order. Periodic images count, too.
std::vector<std::vector<double>> distances_in(const ObstacleArray& array) {
  std::vector<std::vector<double>> all;
  for (const Obstacle& obstacle : array.obstacles()) {
    std::vector<Obstacle> near;
    array.gather({obstacle.x, obstacle.y, 0, 0, 0, 0, 3}, near);
    std::vector<double>& distances = all.emplace_back();
    distances.reserve(near.size());
    for (const Obstacle& other : near) distances.push_back(std::hypot(other.x, other.y));
    std::ranges::sort(distances);
  }
  return all;
}

RunResult lattice_result(DropletRun run) {
  while (!run.advance(1000)) continue;
  return run.result();
}

double slope(const RunResult& result) { return result.lateral / result.distance; }

TEST(Lattice, HasFourNeighboursAtTheExactGapAcrossItsBox) {
  for (const double angle : {-31.0, 0.0, 11.0, 45.0}) {
    const ObstacleParameters used = lattice_disk(angle).obstacles;
    const ObstacleArray array = lattice_obstacles(used, 3);
    EXPECT_NEAR(static_cast<double>(array.obstacles().size()), used.box * used.box / 2.25, 1e-6);
    const double t = used.lattice_angle * degree;
    for (const Obstacle& obstacle : array.obstacles()) {
      EXPECT_EQ(obstacle.radius, 0.15);
      std::vector<Obstacle> near;
      array.gather({obstacle.x, obstacle.y, 0, 0, 0, 0, 1.4}, near);
      const auto has = [&](double x, double y) {
        return std::any_of(near.begin(), near.end(), [&](const Obstacle& other) {
          return std::hypot(other.x - x, other.y - y) < 1e-9;
        });
      };
      EXPECT_TRUE(has(1.5 * std::cos(t), 1.5 * std::sin(t)) && has(-1.5 * std::sin(t), 1.5 * std::cos(t)) &&
                  has(-1.5 * std::cos(t), -1.5 * std::sin(t)) && has(1.5 * std::sin(t), -1.5 * std::cos(t)))
          << angle << " at " << obstacle.x << ", " << obstacle.y;
    }
  }
}

TEST(Lattice, HasTheCellOfCrystallography) {
  // At the tangent 1/3, a period of the square lattice has ten cells. A period of the triangular lattice has
  // 2 posts at 0 and 30 degrees, and 14 posts at 19.1 degrees, where the tangent is sqrt(3)/5. (The sqrt(7)
  // by sqrt(21) cell is known from graphene.) A period of the rhombic lattice with a shift of a third has
  // three columns. A large box contains several periods.
  struct Cell {
    LatticeKind kind;
    double tangent, largest_box, length, box;
    std::size_t num_posts;
  };
  for (const auto& [kind, tangent, largest_box, length, box, num_posts] :
       {Cell{LatticeKind::square, 1.0 / 3, 7, std::sqrt(10), std::sqrt(10), 10},
        Cell{LatticeKind::triangular, std::sqrt(3) / 5, 10, std::sqrt(7), std::sqrt(21), 14},
        Cell{LatticeKind::triangular, 0, 7, 3, std::sqrt(3) * 2, 12},
        Cell{LatticeKind::triangular, 1 / std::sqrt(3), 7, std::sqrt(3) * 2, 3, 12},
        Cell{LatticeKind::rhombic, 1.0 / 3, 7, 3, 3, 9}, Cell{LatticeKind::rhombic, -0.25, 9, 4, 4, 16}}) {
    const ObstacleParameters used = small_lattice(kind, std::atan(tangent) / degree, largest_box);
    EXPECT_NEAR(used.period().along(), 2 * length, 1e-12);
    EXPECT_NEAR(used.box, 2 * box, 1e-12);
    EXPECT_NEAR(std::tan(used.lattice_angle * degree), tangent, 1e-12);
    EXPECT_EQ(lattice_obstacles(used, 1).obstacles().size(), num_posts);
    EXPECT_NEAR(lattice_density(used) * used.period().area(), static_cast<double>(num_posts), 1e-9);
  }
}

TEST(Lattice, HasItsNearestNeighboursAtThePitchAcrossItsPeriod) {
  for (const double angle : {-29.0, -10.0, 0.0, 17.3, 30.0}) {
    const ObstacleParameters triangular = small_lattice(LatticeKind::triangular, angle, 130);
    EXPECT_NEAR(lattice_density(triangular), 2 / (std::sqrt(3) * 4), 1e-12);
    EXPECT_NEAR(row_spacing(triangular), std::sqrt(3), 1e-12);
    for (const auto& distances : distances_in(lattice_obstacles(triangular, 1))) {
      for (int i = 1; i <= 6; ++i) EXPECT_NEAR(distances.at(i), 2, 1e-9) << angle;
      EXPECT_TRUE(distances.size() == 7 || distances[7] > 2.9) << angle;
    }
    const ObstacleParameters rhombic = small_lattice(LatticeKind::rhombic, angle, 130);
    const double tilt = rhombic.lattice_angle * degree;
    EXPECT_NEAR(lattice_density(rhombic), 0.25, 1e-12);
    EXPECT_NEAR(row_spacing(rhombic), 2 * std::cos(tilt), 1e-12);
    for (const auto& distances : distances_in(lattice_obstacles(rhombic, 1))) {
      EXPECT_NEAR(distances.at(1), 2, 1e-9) << angle;
      EXPECT_NEAR(distances.at(2), 2, 1e-9) << angle;
      for (int i = 3; i <= 4; ++i)
        EXPECT_NEAR(distances.at(i), 2 * std::hypot(1, std::remainder(std::tan(tilt), 1)), 1e-9) << angle;
    }
  }
}

TEST(Lattice, IsTheNearestThatIsPeriodicOfEveryKind) {
  // For comparison, the test searches all lattice vectors along and across the flow for the angle nearest to
  // the given angle.
  for (const LatticeKind kind : {LatticeKind::triangular, LatticeKind::rhombic})
    for (const double angle : {0.0, 4.0, -20.0, 27.7}) {
      const auto found = nearest_lattice({.box = 20, .lattice = kind, .pitch = 0.7, .lattice_angle = angle});
      ASSERT_TRUE(found);
      double least = 90;
      const double period = 20 / 0.7;
      for (int p = 1; p < 100; ++p)
        for (int q = -100; q < 100; ++q) {
          const bool is_rhombic = kind == LatticeKind::rhombic;
          const double tilt = std::atan2(is_rhombic ? q : std::sqrt(3) * q, p);
          const bool is_whole = std::gcd(p, q) == 1;
          const double half = (p - q) % 2 == 0 ? 0.5 : 1;
          const double along = is_rhombic ? p : half * std::sqrt(p * p + 3 * q * q);
          const double across = is_rhombic ? 1 : along * std::sqrt(3) / (p % 3 == 0 ? 3 : 1);
          if (is_whole && along <= period && across <= period)
            least = std::min(least, std::abs(tilt / degree - angle));
        }
      EXPECT_NEAR(std::abs(found->angle - angle), least, 1e-9) << name(kind) << ' ' << angle;
      EXPECT_LE(std::max(found->box, found->length), 20);
      EXPECT_GT(std::min(found->box, found->length), 10) << "several periods where they fit";
    }
}

TEST(Lattice, IsTheNearestThatIsPeriodic) {
  // For comparison, the test tries all boxes.
  for (const double angle : {0.0, 4.0, -20.0, 33.3, 45.0}) {
    const auto found = nearest_lattice({.box = 40, .pitch = 0.7, .lattice_angle = angle});
    double least = 90;
    for (int p = 0; p < 80; ++p)
      for (int q = -80; q < 80; ++q)
        if (const double box = 0.7 * std::hypot(p, q); box >= 5 && box <= 40)
          least = std::min(least, std::abs(std::atan2(q, p) / degree - angle));
    ASSERT_TRUE(found);
    EXPECT_NEAR(std::abs(found->angle - angle), least, 1e-9);
  }
  EXPECT_EQ(nearest_lattice({.box = 40, .pitch = 0.7})->p, 57) << "the largest box of the untilted ones";
  EXPECT_FALSE(nearest_lattice({.box = 5.2, .pitch = 0.7}));
}

TEST(Lattice, LeavesTheReleaseToTheSeed) {
  // The start is uniform in the part of a unit cell in which the droplet touches nothing. In coordinates
  // along the lattice, each half of the cell is therefore equally likely. For 400 seeds the tolerance is five
  // standard deviations of a fair coin.
  const double taken = (0.15 + 0.55) / 1.5;
  int num_ahead = 0;
  int num_above = 0;
  std::set<double> places;
  for (std::uint32_t seed = 1; seed <= 400; ++seed) {
    const ObstacleParameters used = lattice_disk(11).obstacles;
    const ObstacleArray array = lattice_obstacles(used, seed);
    std::vector<Obstacle> near;
    array.gather({used.box / 2, used.box / 2, 0, 0, 0, 0, 1.2}, near);
    const Obstacle nearest = *std::min_element(near.begin(), near.end(), [](const auto& a, const auto& b) {
      return std::hypot(a.x, a.y) < std::hypot(b.x, b.y);
    });
    EXPECT_GE(std::hypot(nearest.x, nearest.y) / 1.5, taken - 1e-9);
    const double t = used.lattice_angle * degree;
    num_ahead += nearest.x * std::cos(t) + nearest.y * std::sin(t) > 0;
    num_above += -nearest.x * std::sin(t) + nearest.y * std::cos(t) > 0;
    places.insert(nearest.x);
  }
  EXPECT_NEAR(num_ahead, 200, 50);
  EXPECT_NEAR(num_above, 200, 50);
  EXPECT_EQ(places.size(), 400u);
}

TEST(Lattice, StartsAFreeDropletAtTheCentreOfTheBox) {
  for (const Model model : {Model::dp, Model::sp}) {
    RunParameters run = lattice_disk(11, 5);
    run.model = model;
    if (model == Model::dp) run.dp.vertices = 64;
    run.wall_stiffness = model == Model::sp ? run.wall_stiffness : std::nullopt;
    run.time_step = 1e-3;
    run = resolve(run);
    const DropletRun started(run);
    const DropletState& state = started.droplet().state();
    for (const int axis : {0, 1})
      EXPECT_NEAR(state.frame.global(state.centre())[axis], run.obstacles.box / 2, 1e-6);
  }
}

// A rigid disk that slowly sinks past an obstacle leaves it at a lateral distance b = (sigma + sigma_ob)/2,
// on the side to which it was pushed. Consider a row with the tilt t and the spacing a. If a sin t < b, the
// disk touches the next obstacle of the row, so it follows the row (Frechette and Drazer, J. Fluid Mech. 627,
// 379 (2009)). The square lattice has two kinds of rows: with the tilt t and the spacing a, and with the tilt
// t - 45 degrees and the spacing sqrt(2) a.
TEST(Lattice, LeadsADiskAlongItsRows) {
  for (const double angle : {-20.0, -8.0, 8.0, 20.0})
    EXPECT_NEAR(slope(lattice_result(DropletRun(lattice_disk(angle)))), std::tan(angle * degree), 0.02)
        << angle;
  for (const double angle : {35.0, 40.0})
    EXPECT_NEAR(slope(lattice_result(DropletRun(lattice_disk(angle)))), std::tan((angle - 45) * degree), 0.02)
        << angle;
}

// Droplets follow a row if a sin t < b = 0.65. The rows of the triangular lattice are sqrt(3)/2 a apart. In
// the rows of the rhombic lattice the obstacles are a/cos t apart.
TEST(Lattice, LeadsADiskAlongTheRowsOfEveryKind) {
  for (const LatticeKind kind : {LatticeKind::triangular, LatticeKind::rhombic})
    for (const double angle : {-12.0, 8.0})
      EXPECT_NEAR(slope(lattice_result(DropletRun(lattice_disk(angle, 1, kind)))), std::tan(angle * degree),
                  0.02)
          << name(kind) << ' ' << angle;
}

TEST(Lattice, ReleasesDropletsWhereTheyTouchNothing) {
  for (const LatticeKind kind : {LatticeKind::triangular, LatticeKind::rhombic})
    for (std::uint32_t seed = 1; seed <= 100; ++seed) {
      const ObstacleParameters used = small_lattice(kind, -20, 80);
      const ObstacleArray array = lattice_obstacles(used, seed);
      std::vector<Obstacle> near;
      array.gather({used.period().along() / 2, used.box / 2, 0, 0, 0, 0, 3}, near);
      for (const Obstacle& post : near) EXPECT_GE(std::hypot(post.x, post.y), 0.7 - 1e-9) << seed;
    }
}

TEST(Lattice, LeadsADiskStraightWhenItIsSymmetric) {
  for (const double angle : {0.0, 45.0}) {
    double lateral = 0;
    double distance = 0;
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
      const RunResult result = lattice_result(DropletRun(lattice_disk(angle, seed)));
      EXPECT_LE(std::abs(result.lateral), 1.5) << "it stays in its lane, seed " << seed;
      lateral += result.lateral;
      distance += result.distance;
    }
    EXPECT_LT(std::abs(lateral / distance), 0.005) << angle;
  }
}

TEST(Lattice, LeadsADiskThatFeelsNothingStraight) {
  RunParameters run = lattice_disk(11);
  run.wall_stiffness = 1e-12;
  const RunResult result = lattice_result(DropletRun(run));
  EXPECT_GT(result.distance, 100);
  EXPECT_NEAR(result.lateral, 0, 1e-8);
}

TEST(Lattice, LeadsToTheOtherSideInAMirror) {
  const RunParameters run = lattice_disk(13);
  const ObstacleArray array = lattice_obstacles(run.obstacles, run.seed);
  std::vector<Obstacle> mirrored(array.obstacles().begin(), array.obstacles().end());
  for (Obstacle& obstacle : mirrored) obstacle.y = array.period().box - obstacle.y;
  const RunResult result = lattice_result(DropletRun(run));
  const RunResult mirror =
      lattice_result(DropletRun(run, std::make_shared<ObstacleArray>(array.period().box, mirrored)));
  EXPECT_GT(result.lateral, 10);
  EXPECT_NEAR(mirror.lateral, -result.lateral, 1e-6);
  EXPECT_NEAR(mirror.distance, result.distance, 1e-6);

  // The mirror image of a lattice is the lattice with the opposite tilt, except for a shift.
  const ObstacleArray opposite = lattice_obstacles(lattice_disk(-13).obstacles, run.seed);
  ASSERT_EQ(opposite.obstacles().size(), mirrored.size());
  EXPECT_EQ(opposite.period().box, array.period().box);
  const double dx = opposite.obstacles()[0].x - mirrored[0].x;
  const double dy = opposite.obstacles()[0].y - mirrored[0].y;
  for (const Obstacle& obstacle : mirrored) {
    std::vector<Obstacle> near;
    const auto inside = [&](double value) {
      return value - array.period().box * std::floor(value / array.period().box);
    };
    opposite.gather({inside(obstacle.x + dx), inside(obstacle.y + dy), 0, 0, 0, 0, 0}, near);
    ASSERT_EQ(near.size(), 1u);
    EXPECT_LT(std::hypot(near[0].x, near[0].y), 1e-9);
  }
}

}  // namespace
}  // namespace clog

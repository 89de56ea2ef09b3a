#include "clog/core/droplet/equilibrium.hpp"
#include "clog/core/model/model.hpp"

#include "clog/core/droplet/release.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "clog/core/run/droplet_run.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/units.hpp"
#include "support.hpp"

namespace clog {
namespace {

using std::numbers::pi;

RunParameters robust(double line_tension = 1) {
  RunParameters run;
  run.dp.line_tension = line_tension;
  run.dp.vertices = 128;
  run.drag.terminal_speed = 0.1;
  run.obstacles.box = 20;
  run.max_time = 1000;
  return run;
}
RunParameters heavy_interface() {
  RunParameters run = robust();
  run.dp.perimeter_spring = PerimeterSpring::mean;
  run.dp.gravity = Gravity::vertex;
  return run;
}
RunParameters soft_disk(double wall_stiffness = 5) {
  RunParameters run = robust();
  run.model = Model::sp;
  run.dp.vertices.reset();
  run.wall_stiffness = wall_stiffness;
  return run;
}

/// A droplet at rest above obstacles around x = 10.
DropletState droplet_above(const RunParameters& run, double y) {
  DropletState state = test::state_of(model_of(run).free_shape(run));
  state.x() += 9.3;
  state.y() += y;
  return state;
}
DropletRun falls_onto(RunParameters run, std::vector<Obstacle> obstacles, double y = 10.02) {
  run = resolve(run);
  return {run, std::make_shared<ObstacleArray>(20, std::move(obstacles)), droplet_above(run, y), 2.0};
}
const std::vector<Obstacle> narrow_gap{{10, 9.6, 0.15}, {10, 10.4, 0.15}};
const std::vector<Obstacle> single{{10, 10, 0.15}};

/// The centroid of the area. The mean of the vertices is not used, because the mean also moves if only the
/// interface slides around the droplet.
Eigen::Array2d centre(const DropletState& state) {
  return state.size() > 1 ? area_centroid(state.position) : state.centre();
}

RunResult finished(DropletRun run) {
  while (!run.advance(100)) continue;
  return run.result();
}

class Certified : public testing::TestWithParam<const char*> {
 protected:
  RunParameters parameters() const {
    const std::string_view model = GetParam();
    return model == "robust" ? robust() : model == "heavy_interface" ? heavy_interface() : soft_disk();
  }
};
INSTANTIATE_TEST_SUITE_P(Models, Certified, testing::Values("robust", "heavy_interface", "soft_disk"),
                         [](const auto& model) { return model.param; });

TEST_P(Certified, ADropletInAGapClogsWhereItComesToRest) {
  RunParameters run = parameters();
  run.clog_detection = ClogDetection::threshold;
  const RunResult waited = finished(falls_onto(run, narrow_gap));
  run.clog_detection = ClogDetection::certified;
  const RunResult certified = finished(falls_onto(run, narrow_gap));
  ASSERT_EQ(waited.status, RunStatus::clogged);
  ASSERT_EQ(certified.status, RunStatus::clogged);
  EXPECT_EQ(waited.clogged_by, FoundBy::threshold);
  EXPECT_EQ(certified.clogged_by, FoundBy::certified);
  EXPECT_EQ(waited.stability, Stability::stable);
  EXPECT_EQ(certified.stability, Stability::stable);
  EXPECT_NEAR(certified.distance, waited.distance, 1e-3);
  EXPECT_NEAR(certified.lateral, waited.lateral, 1e-3);
  EXPECT_NEAR(certified.shape_parameter, waited.shape_parameter, 1e-3);
  EXPECT_LT(certified.steps, 0.6 * static_cast<double>(waited.steps));
}

TEST_P(Certified, ADropletThatBalancesOnAnObstacleSlipsOff) {
  RunParameters run = parameters();
  run.clog_detection = ClogDetection::certified;
  DropletRun balanced = falls_onto(run, single, 10 + 1e-5);
  double slowest = 1;
  while (!balanced.advance(1))
    if (balanced.time() > 10) slowest = std::min(slowest, balanced.kinetic_energy_ratio());
  EXPECT_LT(slowest, 5e-5) << "it never looked as if it were at rest";
  EXPECT_EQ(balanced.result().status, RunStatus::passed);
}

TEST_P(Certified, ADropletThatStopsInABalanceRunsOn) {
  RunParameters run = parameters();
  run.clog_energy = 1e-14;
  DropletRun balanced = falls_onto(run, single, 10 + 1e-12);
  std::vector<std::vector<std::byte>> snapshots;
  double slowest = 1;
  while (!balanced.advance(1)) {
    if (balanced.time() > 10) slowest = std::min(slowest, balanced.kinetic_energy_ratio());
    if (snapshots.empty() || balanced.snapshot() != snapshots.back())
      snapshots.push_back(balanced.snapshot());
  }
  EXPECT_LT(slowest, 0.1 * run.clog_energy) << "it did not stop";
  EXPECT_EQ(balanced.result().status, RunStatus::passed);
  EXPECT_EQ(balanced.result().stability, Stability::none);
  const auto obstacles = std::make_shared<ObstacleArray>(20, single);
  for (const std::vector<std::byte>& snapshot : snapshots) {
    if (snapshot.empty()) continue;
    RunResult resumed = finished(DropletRun::resume(balanced.parameters(), obstacles, snapshot));
    EXPECT_EQ(resumed.steps, balanced.result().steps);
    EXPECT_EQ(resumed.distance, balanced.result().distance);
  }
}

TEST_P(Certified, TheCourseOfARunDoesNotDependOnIt) {
  RunParameters run = parameters();
  run.clog_detection = ClogDetection::certified;
  DropletRun certified = falls_onto(run, single, 10 + 1e-5);
  run.clog_detection = ClogDetection::threshold;
  DropletRun other = falls_onto(run, single, 10 + 1e-5);
  for (int i = 0; i < 50; ++i) {
    certified.advance(20);
    other.advance(20);
    ASSERT_TRUE((certified.droplet().state().position == other.droplet().state().position).all());
  }
}

TEST_P(Certified, RestIsFoundFromNearbyOnly) {
  RunParameters run = resolve(parameters());
  run.clog_detection = ClogDetection::threshold;
  DropletRun droplet = falls_onto(run, narrow_gap);
  while (droplet.time() < 1 || droplet.kinetic_energy_ratio() > 1e-4) droplet.advance(1);
  const DropletState slow = droplet.droplet().state();
  const auto found = model_of(run).equilibrium(run, droplet.obstacles(), slow);
  ASSERT_TRUE(found.has_value());
  while (!droplet.advance(100)) continue;
  EXPECT_LT((centre(*found) - centre(droplet.droplet().state())).matrix().norm(), 1e-3);
  DropletState far = slow;
  far.x() -= 2 * farthest_rest;
  EXPECT_FALSE(model_of(run).equilibrium(run, droplet.obstacles(), far).has_value());
}

TEST_P(Certified, AFallingDropletHasNoEquilibrium) {
  const RunParameters run = resolve(parameters());
  EXPECT_FALSE(model_of(run).equilibrium(run, test::no_obstacles(), droplet_above(run, 10)).has_value());
}

TEST_P(Certified, ADropletOnAFlatWallCouldDriftAside) {
  RunParameters run = parameters();
  run.clog_energy = 1e-10;
  run.clog_detection = ClogDetection::certified;
  const RunResult result = finished(DropletRun(test::onto_wall(run)));
  EXPECT_EQ(result.status, RunStatus::clogged);
  EXPECT_EQ(result.clogged_by, FoundBy::threshold);
  EXPECT_EQ(result.stability, Stability::unknown);
}

TEST(Equilibrium, OfASoftDiskInAGapIsWhereTheForcesBalance) {
  // Two springs at an angle to the flow balance the weight. Each spring has the force k (r - d), so 2 k (r -
  // d) (10 - x)/d = M g.
  const RunParameters run = resolve(soft_disk());
  const double k = 4 * 5;
  const auto pull = [&](double x) {
    const double d = std::hypot(10 - x, 0.4);
    return pi / 4 - 2 * k * (0.65 - d) * (10 - x) / d;
  };
  double low = 9.5, high = 9.7;  // from both of these places the force pushes the disk towards the balance
  ASSERT_GT(pull(low), 0);
  ASSERT_LT(pull(high), 0);
  while (high - low > 1e-14) (pull((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  Eigen::ArrayXd position(2);
  position << low + 0.01, 10.01;
  const auto found = model_of(run).equilibrium(run, ObstacleArray(20, narrow_gap), test::state_of(position));
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->position[0], low, 1e-8);
  EXPECT_NEAR(found->position[1], 10, 1e-8);
}

/// Points that springs tie to their places and to their neighbours. A contact for each coordinate, much
/// stiffer than the springs, acts as an upper bound. All quantities are in units of a point's weight.
class PointsWithContacts {
 public:
  static constexpr Eigen::Index num_points = 16;
  static constexpr Eigen::Index size = 2 * num_points;
  static constexpr double stiffness_of_contact = 5000;

  PointsWithContacts() : stiffness_(Eigen::MatrixXd::Zero(size, size)), load_(size), bound_(size) {
    for (Eigen::Index i = 0; i < size; ++i) {
      const auto phase = static_cast<double>(i);
      const Eigen::Index next = (i + 1) % size;
      load_[i] = 0.3 * std::sin(2.1 * phase);
      bound_[i] = 0.002 * std::cos(1.3 * phase);
      stiffness_(i, i) += 20;
      Eigen::Matrix2d spring;
      spring << 50, -50, -50, 50;
      stiffness_({i, next}, {i, next}) += spring;
    }
  }

  /// Assumes which contacts touch, and solves for the position. Repeats this until exactly the assumed
  /// contacts touch.
  Eigen::VectorXd rest() const {
    Eigen::VectorXd position = Eigen::VectorXd::Zero(size);
    for (int attempt = 0; attempt < 100; ++attempt) {
      const Eigen::VectorXd contacts = stiffness_of_contact * touches(position);
      const Eigen::MatrixXd all = stiffness_ + Eigen::MatrixXd(contacts.asDiagonal());
      Eigen::VectorXd next = all.ldlt().solve(load_ + contacts.cwiseProduct(bound_));
      if (touches(next) == touches(position)) return next;
      position = next;
    }
    throw std::logic_error("no set of contacts belongs to its own positions");
  }
  Eigen::VectorXd touches(const Eigen::VectorXd& position) const {
    return (position.array() > bound_.array()).cast<double>();
  }

  void update_contacts(const DropletState&, const Travel&) {}
  void evaluate(const DropletState& state, Eigen::ArrayXd& force) {
    const Eigen::VectorXd position = state.position;
    const Eigen::VectorXd depth = (position - bound_).cwiseMax(0);
    force = point_weight * (load_ - stiffness_ * position - stiffness_of_contact * depth).array();
  }
  std::optional<DropletState> found_from(const Eigen::ArrayXd& position) {
    const auto along_coordinates = [](const DropletState&) {
      Axes axes{
          .directions = Eigen::SparseMatrix<double>(size, size), .num_tangential = num_points, .slide = {}};
      axes.directions.setIdentity();
      return axes;
    };  // NOLINT(clang-analyzer-unix.Malloc): the matrix owns this memory after the move
    return find_equilibrium(EquilibriumForces::of(*this, along_coordinates, true), test::state_of(position));
  }

 private:
  static constexpr double point_weight = units::droplet_mass * units::gravity / num_points;
  Eigen::MatrixXd stiffness_;
  Eigen::VectorXd load_, bound_;
};

TEST(Equilibrium, IsFoundThoughContactsOpenAndCloseOnTheWay) {
  PointsWithContacts points;
  const Eigen::VectorXd rest = points.rest();
  for (const double offset : {-0.01, 0.0, 0.01}) {
    const Eigen::ArrayXd start = Eigen::ArrayXd::Constant(PointsWithContacts::size, offset);
    ASSERT_GE((points.touches(start) - points.touches(rest)).cwiseAbs().sum(), 8) << "contacts change";
    const auto found = points.found_from(start);
    ASSERT_TRUE(found.has_value());
    EXPECT_LT((found->position.matrix() - rest).lpNorm<Eigen::Infinity>(), 1e-8);
  }
}

TEST(Equilibrium, IsFoundAtTheFirstSearchEvenIfItsFirstStepsLeadAstray) {
  // In half of the cases the first steps of the search lead away from the place of rest. The search must then
  // return to its start, and find the place of rest with halved steps.
  int num_early = 0;
  for (const std::uint32_t seed : {3u, 7u, 11u, 14u, 16u}) {
    RunParameters run;
    run.dp.line_tension = 0.6;
    run.dp.vertices = 256;
    run.dp.perimeter_spring = PerimeterSpring::rest;
    run.dp.perimeter_stiffness = 0.1 * run.dp.line_tension;
    run.dp.gravity = Gravity::vertex;
    run.obstacles.gap = 0.3;
    run.obstacles.density = ObstacleDensity::share_of_saturated(0.65);
    run.obstacles.box = 50;
    run.obstacles.boxes = 4;
    run.max_time = 6000;
    run.seed = seed;
    const RunResult result = finished(DropletRun(resolve(run)));
    EXPECT_EQ(result.clogged_by, FoundBy::certified);
    constexpr double second_search = 1e-5;
    if (result.kinetic_energy_ratio > second_search) ++num_early;
  }
  EXPECT_GE(num_early, 4);
}

TEST(Equilibrium, TooFarAwayIsRefused) {
  // The droplet is so soft that it touches both obstacles at every place that the test uses, so its energy is
  // convex.
  const RunParameters run = resolve(soft_disk(2));
  const ObstacleArray obstacles(20, narrow_gap);
  Eigen::ArrayXd position(2);
  position << 9.7, 10;
  DropletState state = test::state_of(position);
  const auto search = [&] { return model_of(run).equilibrium(run, obstacles, state); };
  for (int step = 0; step < 100 && !search(); ++step) state.position[0] -= 0.01;
  ASSERT_TRUE(search().has_value());
  const double rest = search()->position[0];
  state.position[0] = rest - 0.9 * farthest_rest;
  EXPECT_TRUE(search().has_value());
  state.position[0] = rest - 1.1 * farthest_rest;
  EXPECT_FALSE(search().has_value());
}

TEST(Equilibrium, OnTopOfAnObstacleIsRefused) {
  const RunParameters run = resolve(soft_disk());
  Eigen::ArrayXd position(2);
  position << 10 - 0.65 + pi / (16 * 5), 10;  // the forces balance here
  const DropletState state = test::state_of(position);
  EXPECT_FALSE(model_of(run).equilibrium(run, ObstacleArray(20, single), state).has_value());
  // The stiffness across the flow is minus the contact's force divided by the distance of the centres.
  EXPECT_EQ(model_of(run).stability(run, ObstacleArray(20, single), state), Stability::unstable);
}

TEST(Equilibrium, IsOfUnknownStabilityWithoutResistanceOrSelfContact) {
  const RunParameters disk = resolve(soft_disk());
  EXPECT_EQ(model_of(disk).stability(disk, test::no_obstacles(), droplet_above(disk, 10)),
            Stability::unknown);
  RunParameters run = robust();
  DropletRun held = falls_onto(run, narrow_gap);
  while (!held.advance(100)) continue;
  run = held.parameters();
  const auto of_rest = [&] { return model_of(run).stability(run, held.obstacles(), held.droplet().state()); };
  EXPECT_EQ(of_rest(), Stability::stable);
  run.dp.self_contact = SelfContact::off;
  EXPECT_EQ(of_rest(), Stability::unknown);
}

/// A run through an orifice with round tips. Droplets with line tensions up to about 1.26 pass this orifice.
/// The tests use line tensions close to this limit.
DropletRun through_orifice(double line_tension, ClogDetection detection) {
  RunParameters run = robust(line_tension);
  run.clog_detection = detection;
  run.time_step = 1e-3;
  return DropletRun(test::in_channel(run, {.orifice = 0.7, .tip_radius = 0.1, .start = -0.8, .end = 0.6}));
}

TEST(Equilibrium, IsNotSeenByADropletThatCreepsThroughAnOrifice) {
  DropletRun droplet = through_orifice(1.25, ClogDetection::certified);
  double slowest = 1;
  for (int num_checks = 1; !droplet.advance(1); ++num_checks) {
    if (droplet.time() > 5) slowest = std::min(slowest, droplet.kinetic_energy_ratio());
    if (num_checks % 100 == 0) {
      ASSERT_FALSE(model_of(droplet.parameters())
                       .equilibrium(droplet.parameters(), droplet.obstacles(), droplet.droplet().state())
                       .has_value());
    }
  }
  EXPECT_LT(slowest, 5e-5) << "it never looked as if it were at rest";
  EXPECT_EQ(droplet.result().status, RunStatus::passed);
}

TEST(Equilibrium, IsSeenByOneThatIsHeldThere) {
  const RunResult certified = finished(through_orifice(1.27, ClogDetection::certified));
  const RunResult waited = finished(through_orifice(1.27, ClogDetection::threshold));
  EXPECT_EQ(certified.clogged_by, FoundBy::certified);
  EXPECT_EQ(waited.clogged_by, FoundBy::threshold);
  EXPECT_NEAR(certified.distance, waited.distance, 1e-3);
}

}  // namespace
}  // namespace clog

#include "clog/campaign/refinement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "clog/fit/fitted_curve.hpp"

namespace clog::campaign {
namespace {

using Kind = RefinementGoal::Kind;

constexpr int num_places = 41;

std::vector<fit::CurvePlace> line() {
  std::vector<fit::CurvePlace> places;
  for (int i = 0; i < num_places; ++i) places.emplace_back(-2 + 0.1 * i, 0);
  return places;
}

/// Log lambda has a peak of 4 at 0; errors are of this deviation, and are alike within 0.3.
fit::Curve peaked(double deviation) {
  const std::vector<fit::CurvePlace> places = line();
  fit::Curve curve{Eigen::VectorXd(num_places), Eigen::MatrixXd(num_places, num_places)};
  for (int i = 0; i < num_places; ++i) {
    const double place = places[static_cast<std::size_t>(i)][0];
    curve.mean[i] = 4 - 4 * place * place / (1 + place * place);
    for (int j = 0; j < num_places; ++j)
      curve.covariance(i, j) = deviation * deviation * std::exp(-0.5 * std::pow((i - j) * 0.1 / 0.3, 2));
  }
  return curve;
}

std::vector<ExpectedRun> alike() { return std::vector<ExpectedRun>(num_places, {1, 10}); }

RoundLimits limits(double work) {
  return {.seeds_per_block = 4, .blocks_left = std::vector<std::int64_t>(num_places, 100), .work = work};
}

std::int64_t sum(const std::vector<std::int64_t>& blocks, int from, int to) {
  return std::accumulate(blocks.begin() + from, blocks.begin() + to, std::int64_t{0});
}

TEST(Refinement, SpreadsBlocksEvenlyWhereAllIsAlike) {
  const std::vector<std::int64_t> blocks =
      choose_blocks(peaked(0.5), alike(), {Kind::curve, 0.1}, limits(400));
  EXPECT_EQ(sum(blocks, 0, num_places), 10);  // of 40 each
  for (const int begin : {0, 10, 20, 30}) EXPECT_GE(sum(blocks, begin, begin + 11), 2);
}

TEST(Refinement, PrefersWhatIsCheap) {
  std::vector<ExpectedRun> runs = alike();
  for (int i = 21; i < num_places; ++i) runs[static_cast<std::size_t>(i)].work = 1000;
  const std::vector<std::int64_t> blocks = choose_blocks(peaked(0.5), runs, {Kind::curve, 0.1}, limits(400));
  EXPECT_EQ(sum(blocks, 21, num_places), 0);
}

TEST(Refinement, PrefersPlacesWhereRunsClog) {
  std::vector<ExpectedRun> runs = alike();
  for (int i = 0; i < 20; ++i) runs[static_cast<std::size_t>(i)].num_clogs = 0.01;
  const std::vector<std::int64_t> blocks = choose_blocks(peaked(0.5), runs, {Kind::curve, 0.1}, limits(400));
  EXPECT_GT(sum(blocks, 20, num_places), sum(blocks, 0, 20));
}

TEST(Refinement, LooksForThePeakWhereItMayBe) {
  const std::vector<std::int64_t> blocks =
      choose_blocks(peaked(0.2), alike(), {Kind::peak, 0.1}, limits(400));
  EXPECT_GE(sum(blocks, 12, 29), 8);
}

TEST(Refinement, LooksForACrossingWhereItMayBe) {
  const RefinementGoal goal{Kind::crossing, 0.1, std::exp(2.0)};  // at -1 and 1
  const std::vector<std::int64_t> blocks = choose_blocks(peaked(0.2), alike(), goal, limits(400));
  EXPECT_GE(sum(blocks, 5, 16) + sum(blocks, 25, 36), 8);
}

TEST(Refinement, KeepsToTheBudgetAndToTheSeedsLeft) {
  RoundLimits none = limits(400);
  none.most_work = 39;  // a block costs 40
  EXPECT_EQ(sum(choose_blocks(peaked(0.5), alike(), {}, none), 0, num_places), 0);
  RoundLimits few = limits(4000);
  few.blocks_left.assign(num_places, 0);
  few.blocks_left[7] = 3;
  const std::vector<std::int64_t> blocks = choose_blocks(peaked(0.5), alike(), {}, few);
  EXPECT_EQ(blocks[7], 3);
  EXPECT_EQ(sum(blocks, 0, num_places), 3);
}

TEST(Refinement, ChoosesOneBlockAtLeast) {
  EXPECT_EQ(sum(choose_blocks(peaked(0.5), alike(), {}, limits(1e-9)), 0, num_places), 1);
}

TEST(Refinement, ExpectsOfARunWhatRunsNearbyDid) {
  // Speed 0.5 sigma/t0, 200 of work per sigma; a run of 100 t0 gets 50 sigma far.
  const std::vector<RefinedPoint> points = {{{-2, 0}, 5, 100, 200, 20'000}, {{2, 0}, 5, 100, 200, 20'000}};
  const RefinementCandidates candidates{line(), 100};
  const Eigen::VectorXd log_length = Eigen::VectorXd::Constant(num_places, std::log(50.0));
  for (const ExpectedRun& run : expected_runs(points, candidates, log_length)) {
    EXPECT_NEAR(run.num_clogs, 1 - std::exp(-1.0), 1e-12);
    EXPECT_NEAR(run.work, 50 * (1 - std::exp(-1.0)) * 200, 1e-9);
  }
}

TEST(Refinement, SaysHowWellACurveIsKnown) {
  EXPECT_NEAR(known_precision(peaked(0.1), line(), {Kind::curve, 0.1}), std::sinh(0.1959964), 1e-6);
  EXPECT_LT(known_precision(peaked(0.01), line(), {Kind::peak, 0.1}), 0.15);
  EXPECT_GT(known_precision(peaked(1), line(), {Kind::peak, 0.1}), 1);
  EXPECT_LT(known_precision(peaked(0.01), line(), {Kind::crossing, 0.1, std::exp(2.0)}), 0.05);
  EXPECT_TRUE(std::isinf(known_precision(peaked(0.01), line(), {Kind::crossing, 0.1, std::exp(9.0)})));
  EXPECT_TRUE(std::isinf(known_precision(peaked(0.01), line(), {})));
}

TEST(Refinement, NamesItsGoal) {
  EXPECT_EQ((RefinementGoal{Kind::curve, 0.2}).text(), "curve=20%");
  EXPECT_EQ((RefinementGoal{Kind::crossing, 0.05, 10}).text(), "crossing=10:5%");
}

}  // namespace
}  // namespace clog::campaign

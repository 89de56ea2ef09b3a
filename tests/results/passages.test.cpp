#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "clog/core/run/resolve.hpp"
#include "clog/results/comparison.hpp"
#include "clog/results/distance_table.hpp"
#include "clog/results/group_table.hpp"
#include "clog/results/groups.hpp"
#include "clog/sweep/row_check.hpp"
#include "clog/sweep/run_row.hpp"
#include "ended_row.hpp"

namespace clog::results {
namespace {

constexpr double entrance = 1, device_exit = 12;

RunParameters device() {
  RunParameters run;
  run.obstacles.layout = ObstacleLayout::file;
  run.obstacles.own = OwnCircles({{3, 5, 0.3}, {6, 4, 0.3}, {6, 7, 0.3}, {9, 5, 0.3}, {13, 5, 0.3}});
  run.obstacles.box = 10;
  run.obstacles.length = 20;
  run.obstacles.release = Release::entrance;
  run.obstacles.entrance = entrance;
  run.obstacles.exit = device_exit;
  run.max_time = 400;
  return resolve(run);
}

/// @param first_contact_at  distance of the first contact, or empty if the droplet met no obstacle
sweep::RunRow row(std::uint32_t seed, RunStatus status, double distance,
                  std::optional<double> first_contact_at) {
  RunParameters run = device();
  run.seed = seed;
  sweep::RunRow row = sweep::describe(run);
  end_run(row, status, distance);
  row.task = seed;
  row.release[0] = entrance;
  row.release[1] = 5;
  row.contacts.number = first_contact_at ? 1 : 0;
  if (first_contact_at) row.contacts.first_distance = *first_contact_at;
  EXPECT_EQ(sweep::fault_of(row), "");
  return row;
}

std::vector<sweep::RunRow> five_rows() {
  return {row(1, RunStatus::clogged, 1.5, 1.2), row(2, RunStatus::clogged, 5.5, 1.4),
          row(3, RunStatus::passed, 11.1, 1.6), row(4, RunStatus::flowing, 4, 1.0),
          row(5, RunStatus::passed, 11, {})};
}

struct Counts {
  double x;
  int num_passed, num_stopped;
};
void expect_passages(const Group& group, const std::vector<Counts>& expected) {
  ASSERT_EQ(group.passages.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(group.passages[i].x, expected[i].x);
    EXPECT_EQ(group.passages[i].num_passed, expected[i].num_passed) << expected[i].x;
    EXPECT_EQ(group.passages[i].num_stopped, expected[i].num_stopped) << expected[i].x;
  }
}

TEST(Passages, AreThoseOfEachRowOfPostsAndOfTheExit) {
  const std::vector<Group> groups = group_runs(five_rows(), 0.95);
  ASSERT_EQ(groups.size(), 1u);
  // The fourth droplet is beyond x = 5, and still moves.
  expect_passages(groups[0], {{3, 4, 1}, {6, 3, 1}, {9, 2, 2}, {device_exit, 2, 2}});
}

TEST(Passages, AreThoseOfTheUsersLines) {
  const std::vector<double> lines = {2, 4.5};
  const std::vector<Group> groups = group_runs(five_rows(), 0.95, 0, std::numeric_limits<double>::infinity(),
                                               {}, [&](const sweep::RunRow&) { return lines; });
  expect_passages(groups[0], {{2, 5, 0}, {4.5, 4, 1}, {device_exit, 2, 2}});
}

TEST(Passages, ArePrintedALineEach) {
  const std::string text = to_text(group_runs(five_rows(), 0.95), 0.95, SharedParameters::unusual);
  // For 2 of 4 runs these are the exact limits of Clopper and Pearson, as R's binom.test(2, 4) prints them.
  EXPECT_NE(text.find("        9          2   4   0.50  0.07 .. 0.93\n"), std::string::npos) << text;
  EXPECT_NE(text.find("       12          2   4   0.50  0.07 .. 0.93\n"), std::string::npos) << text;
}

TEST(Passages, LengthsOfADeviceAreTheSameWhereTheyAreCompared) {
  const fit::CloggingLength length = group_runs(five_rows(), 0.95)[0].clogging;
  const auto expect_same = [&](const fit::CloggingLength& other) {
    EXPECT_EQ(other.num_runs, length.num_runs);
    EXPECT_EQ(other.length, length.length);
    EXPECT_EQ(other.interval.lower, length.interval.lower);
  };
  const Side side{"here", five_rows(), {}};
  const Comparison same = compare({side, side}, 0.95, std::nullopt).all.at(0);
  expect_same(same.length_here);
  EXPECT_NEAR(same.ratio.ratio, 1, 1e-12);
  const DistanceTable table = distances_of(side, {}, {}, 0.95);
  expect_same(compare_distances({table, table}, 0.95, std::nullopt).all.at(0).length_there);
}

TEST(Passages, LengthsOfADeviceCountFromTheFirstObstacle) {
  const Group group = group_runs(five_rows(), 0.95).at(0);
  EXPECT_EQ(group.clogging.num_runs, 4);
  EXPECT_EQ(group.clogging.num_clogs, 2);
  EXPECT_EQ(group.num_free, 1);
  EXPECT_NEAR(group.clogging.length, (0.3 + 4.1 + 9.5 + 3) / 2, 1e-12);
  EXPECT_NEAR(group.clogging_met.length, group.clogging.length, 1e-12);
}

TEST(Passages, LengthsOfADisplacedReleaseCountFromThere) {
  std::vector<sweep::RunRow> rows = {row(1, RunStatus::clogged, 1.5, 1.2),
                                     row(2, RunStatus::clogged, 2.5, 0.5)};
  rows[1].release[0] = entrance + 3;
  EXPECT_EQ(sweep::fault_of(rows[1]), "");
  const Group group = group_runs(rows, 0.95).at(0);
  ASSERT_FALSE(group.displaced.empty());
  EXPECT_EQ(group.displaced.back(), entrance + 3);
  EXPECT_NEAR(group.clogging.length, (0.3 + 2) / 2, 1e-12);
}

TEST(Passages, AreNotAskedForWithoutADevice) {
  std::vector<sweep::RunRow> rows = five_rows();
  for (sweep::RunRow& row : rows) {
    row.parameters.obstacles.release = Release::anywhere;
    row.parameters.obstacles.entrance = row.parameters.obstacles.exit = 0;
    if (row.status == RunStatus::passed) end_run(row, RunStatus::flowing, row.distance);
  }
  const Group group = group_runs(rows, 0.95).at(0);
  EXPECT_TRUE(group.passages.empty());
  EXPECT_NEAR(group.clogging.length, (1.5 + 5.5 + 11.1 + 4 + 11) / 2, 1e-12);
}

}  // namespace
}  // namespace clog::results

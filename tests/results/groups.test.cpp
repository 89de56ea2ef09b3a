#include "clog/results/groups.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "clog/core/run/resolve.hpp"
#include "clog/sweep/row_check.hpp"
#include "ended_row.hpp"

namespace clog::results {
namespace {

bool is_doubted(const Group& group) {
  return std::ranges::find(group.doubts, Doubt::not_exponential) != group.doubts.end();
}

/// Twelve clogs that follow a Weibull law with the exponent 1.6. The likelihood-ratio test against an
/// exponential law has p = 0.042 (SciPy).
std::vector<sweep::RunRow> clogged_runs(RunParameters run) {
  constexpr double distances[] = {1.4, 2.8, 4.0, 5.1, 6.2, 7.4, 8.6, 9.9, 11.4, 13.2, 15.8, 20.6};
  std::vector<sweep::RunRow> rows;
  for (const double distance : distances) {
    ++run.seed;
    sweep::RunRow row = sweep::describe(resolve(run));
    end_run(row, RunStatus::clogged, distance);
    row.task = run.seed;
    EXPECT_EQ(sweep::fault_of(row), "");
    rows.push_back(row);
  }
  return rows;
}

TEST(Groups, OfTheSameRunsInTwoLaboratoriesAreOneTest) {
  RunParameters run;
  run.laboratory = LaboratoryText("diameter = 1 mm; angle = 20 deg");
  std::vector<sweep::RunRow> rows = clogged_runs(run);
  const Group once = group_runs(rows, 0.95).at(0);
  EXPECT_EQ(once.num_damaged, 0);
  EXPECT_NEAR(once.weibull.p_value, 0.0417, 1e-4);
  EXPECT_TRUE(is_doubted(once));
  for (sweep::RunRow row : clogged_runs(run)) {
    row.parameters.laboratory = LaboratoryText("diameter = 1 mm; angle = 45 deg");
    rows.push_back(row);
  }
  const std::vector<Group> copied = group_runs(rows, 0.95);
  ASSERT_EQ(copied.size(), 2u);
  EXPECT_TRUE(is_doubted(copied[0]));
  EXPECT_TRUE(is_doubted(copied[1]));
  // Two groups of different runs are two tests, so Holm's correction gives p = 0.083.
  RunParameters other = run;
  other.obstacles.gap = 0.4;
  rows = clogged_runs(run);
  for (const sweep::RunRow& row : clogged_runs(other)) rows.push_back(row);
  const std::vector<Group> two = group_runs(rows, 0.95);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_FALSE(is_doubted(two[0]));
  EXPECT_FALSE(is_doubted(two[1]));
}

}  // namespace
}  // namespace clog::results

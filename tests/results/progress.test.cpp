#include "clog/results/progress.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

namespace clog::results {
namespace {

sweep::RunRow row(std::int64_t task, RunStatus status) {
  sweep::RunRow row;
  row.task = task;
  row.status = status;
  return row;
}

/// The progress of a sweep that has four runs to do.
class ProgressTest : public testing::Test {
 protected:
  std::ostringstream out_;
  Progress progress_{out_, Progress::Screen::plain, 2, [](std::int64_t) { return std::int64_t{0}; }};

  /// The last line, cut before the rate, because the rate and the text after it depend on the time.
  std::string line() {
    progress_.finish();
    const std::string text = out_.str();
    const std::string last = text.substr(text.rfind('\n', text.size() - 2) + 1);
    return last.substr(0, last.find(" runs/min"));
  }
  void expect(std::int64_t num_tasks, std::int64_t num_wanted) {
    progress_.expect(std::vector<std::int64_t>(num_tasks), num_wanted);
  }
  void end(std::int64_t task, RunStatus status) {
    progress_.started(task);
    progress_.ended(row(task, status));
  }
};

TEST_F(ProgressTest, CountsWhatIsOver) {
  expect(4, 4);
  end(0, RunStatus::clogged);
  end(1, RunStatus::flowing);
  progress_.started(2);
  EXPECT_EQ(line().find("2/4 done, 1 running, 1 clogged, 1 flowing, "), 0) << line();
}

TEST_F(ProgressTest, CountsDropletsOnAWallAsAtRest) {
  expect(4, 4);
  sweep::RunRow on_wall = row(0, RunStatus::clogged);
  on_wall.parameters.obstacles.layout = ObstacleLayout::wall;
  progress_.started(0);
  progress_.ended(on_wall);
  EXPECT_EQ(line().find("1/4 done, 0 running, 1 at rest, 0 flowing, "), 0) << line();
  end(1, RunStatus::clogged);
  EXPECT_EQ(line().find("2/4 done, 0 running, 1 clogged, 1 at rest, 0 flowing, "), 0) << line();
}

TEST_F(ProgressTest, TakesNoInterruptedRunForDone) {
  expect(4, 4);
  end(0, RunStatus::clogged);
  end(1, RunStatus::interrupted);
  EXPECT_EQ(line().find("1/4 done, 0 running, 1 clogged, 0 flowing, 1 interrupted, "), 0) << line();
}

TEST_F(ProgressTest, CountsTowardsTheWholeAfterAResume) {
  expect(4, 10);
  end(7, RunStatus::clogged);
  EXPECT_EQ(line().find("7/10 done, 6 of them before; now 0 running, 1 clogged, 0 flowing, "), 0) << line();
}

TEST_F(ProgressTest, CountsFurtherRounds) {
  expect(4, 4);
  end(0, RunStatus::clogged);
  expect(3, 8);  // one of the four added runs was done before
  EXPECT_EQ(line().find("2/8 done, 1 of them before; now 0 running, 1 clogged, "), 0) << line();
}

TEST(Progress, JudgesWhatIsLeftByItsOwnParameterSet) {
  std::ostringstream out;
  Progress progress(out, Progress::Screen::plain, 2, [](std::int64_t task) { return task % 2; });
  progress.expect(std::vector<std::int64_t>{0, 2, 4, 1, 3, 5}, 6);
  const auto end = [&](std::int64_t task, double seconds) {
    progress.started(task);
    sweep::RunRow ended = row(task, RunStatus::clogged);
    ended.wall_seconds = seconds;
    progress.ended(ended);
  };
  for (const std::int64_t task : {0, 2, 4}) end(task, 1e6);
  end(1, 10);
  progress.finish();
  // Two runs of about ten seconds each wait for two ranks.
  EXPECT_NE(out.str().find(", 3 s to 36 s left"), std::string::npos) << out.str();
}

}  // namespace
}  // namespace clog::results

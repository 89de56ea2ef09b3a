#include "sweep_progress.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace clog {
namespace {

sweep::RunRow row(std::int64_t task, RunStatus status) {
  sweep::RunRow row;
  row.task = task;
  row.status = status;
  return row;
}

/// Progress of a sweep of which four runs are to be done.
class ProgressTest : public testing::Test {
 protected:
  std::ostringstream out_;
  SweepProgress progress_{out_, SweepProgress::Screen::plain, 2};

  /// The last line, up to the rate, which depends on the time.
  std::string line() {
    progress_.finish();
    const std::string text = out_.str();
    const std::string last = text.substr(text.rfind('\n', text.size() - 2) + 1);
    return last.substr(0, last.find(" runs/min"));
  }
  void end(std::int64_t task, RunStatus status) {
    progress_.started(task);
    progress_.ended(row(task, status));
  }
};

TEST_F(ProgressTest, CountsWhatIsOver) {
  progress_.expect(4, 4);
  end(0, RunStatus::clogged);
  end(1, RunStatus::flowing);
  progress_.started(2);
  EXPECT_EQ(line().find("2/4 done, 1 running, 1 clogged, 1 flowing, "), 0) << line();
}

TEST_F(ProgressTest, TakesNoInterruptedRunForDone) {
  progress_.expect(4, 4);
  end(0, RunStatus::clogged);
  end(1, RunStatus::interrupted);
  EXPECT_EQ(line().find("1/4 done, 0 running, 1 clogged, 0 flowing, 1 interrupted, "), 0) << line();
}

TEST_F(ProgressTest, CountsTowardsTheWholeAfterAResume) {
  progress_.expect(4, 10);
  end(7, RunStatus::clogged);
  EXPECT_EQ(line().find("7/10 done, 6 of them before; now 0 running, 1 clogged, 0 flowing, "), 0) << line();
}

TEST_F(ProgressTest, CountsFurtherRounds) {
  progress_.expect(4, 4);
  end(0, RunStatus::clogged);
  progress_.expect(3, 8);  // one of the four that were added was done before
  EXPECT_EQ(line().find("2/8 done, 1 of them before; now 0 running, 1 clogged, "), 0) << line();
}

}  // namespace
}  // namespace clog

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <string>

#include "clog/sweep/row_check.hpp"
#include "clog/sweep/run_job.hpp"
#include "support.hpp"

namespace {
bool goes_back = false;
time_t seconds_back = 0;
}  // namespace

/// Replaces the function of the C library in this program. Each call returns a time ten seconds before that
/// of the last call.
// NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name): the library's names are reserved
extern "C" int clock_gettime(clockid_t clock, timespec* now) noexcept {
  const auto code = static_cast<int>(syscall(SYS_clock_gettime, clock, now));
  if (goes_back) now->tv_sec -= seconds_back += 10;
  return code;
}

namespace clog::sweep {
namespace {

TEST(RunJob, GivesAnUndamagedRowWhenTheClockGoesBack) {
  const Plan plan(settings_of({{"vertices", "64"}, {"box", "20"}, {"max-time", "20"}, {"seeds", "1"}}));
  RunJob job(plan.task(0), 0);
  goes_back = true;
  while (!job.advance()) {
  }
  goes_back = false;
  EXPECT_GT(seconds_back, 0) << "this program's clock is not the one that is asked";
  EXPECT_GE(job.row().wall_seconds, 0);
  EXPECT_EQ(fault_of(job.row()), "");
}

}  // namespace
}  // namespace clog::sweep

#include "clog/sweep/run_job.hpp"

#include <gtest/gtest.h>

namespace clog::sweep {
namespace {

Plan small_plan(const char* seeds) {
  Settings settings;
  settings.set("vertices", "64");
  settings.set("box", "20");
  settings.set("max-time", "20");
  settings.set("seeds", seeds);
  return Plan(settings);
}

TEST(RunJob, GivesTheRowOfItsRun) {
  const Plan plan = small_plan("5,6");
  RunJob job(plan.task(1), 1);
  while (!job.advance()) {
  }
  DropletRun run(plan.task(1));
  while (!run.advance(100)) {
  }
  const RunRow row = job.row();
  EXPECT_EQ(row.task, 1);
  EXPECT_EQ(row.parameters.seed, 6);
  EXPECT_EQ(row.distance, run.result().distance);
  EXPECT_EQ(row.steps, run.result().steps);
  EXPECT_EQ(row.status, run.result().status);
  EXPECT_GT(row.wall_seconds, 0);
}

TEST(RunJob, IsInterruptedUntilItIsOver) {
  const Plan plan = small_plan("5");
  RunJob job(plan.task(0), 0);
  EXPECT_EQ(job.row().status, RunStatus::interrupted);
}

TEST(RunJob, TurnsAnImpossibleReleaseIntoAFailedRow) {
  // Obstacles so near to each other that some seeds leave no void near the box's centre.
  Settings settings;
  settings.set("obstacle-diameter", "3");
  settings.set("obstacle-gap", "0.06");
  settings.set("obstacle-density", "saturated");
  settings.set("vertices", "64");
  settings.set("self-contact-range", "0.1");
  settings.set("box", "13");
  settings.set("seeds", "51..70");
  const Plan plan(settings);
  int num_failed = 0;
  for (std::int64_t task = 0; task < plan.size(); ++task) {
    RunJob job(plan.task(task), task);
    job.advance();
    const RunRow row = job.row();
    if (row.status != RunStatus::failed) continue;
    ++num_failed;
    EXPECT_TRUE(row.message.starts_with("cannot release the droplet")) << row.message;
    EXPECT_TRUE(job.advance()) << "a failed job is over";
  }
  EXPECT_GT(num_failed, 0);
}

}  // namespace
}  // namespace clog::sweep

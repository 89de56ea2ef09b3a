#include "clog/sweep/run_job.hpp"

#include <chrono>
#include <exception>

namespace clog::sweep {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds slice{5};
constexpr int checks_per_look_at_the_clock = 8;

}  // namespace

RunJob::RunJob(const Plan& plan, std::int64_t task)
    : run_parameters_(plan.task(task)), row_(describe(run_parameters_)) {
  row_.task = task;
}

bool RunJob::advance() {
  const Clock::time_point begin = Clock::now();
  try {
    if (!run_) run_ = std::make_unique<DropletRun>(run_in_array(run_parameters_));
    while (!over_ && Clock::now() - begin < slice) over_ = run_->advance(checks_per_look_at_the_clock);
  } catch (const std::exception& error) {
    over_ = true;
    RunResult failure;
    if (run_) failure = run_->result();
    failure.status = RunStatus::failed;
    failure.message = error.what();
    record(failure, row_);
    run_.reset();
  }
  wall_seconds_ += std::chrono::duration<double>(Clock::now() - begin).count();
  return over_;
}

RunRow RunJob::row() const {
  RunRow row = row_;
  if (run_ || !over_) {
    RunResult result;
    if (run_) result = run_->result();
    if (!over_) result.status = RunStatus::interrupted;
    record(result, row);
  }
  row.wall_seconds = wall_seconds_;
  return row;
}

JobFactory run_jobs(const Plan& plan) {
  return [&plan](std::int64_t task) { return std::make_unique<RunJob>(plan, task); };
}

}  // namespace clog::sweep

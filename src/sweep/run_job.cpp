#include "clog/sweep/run_job.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <exception>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "clog/sweep/row_check.hpp"

namespace clog::sweep {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds slice{5};
constexpr int checks_per_look_at_the_clock = 8;

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Fills in the results of an incomplete run.
void record_interrupted(const FamilyRun& run, RunRow& row) {
  RunResult result = run.result();
  result.status = RunStatus::interrupted;
  record(result, row);
}

}  // namespace

RunJob::RunJob(RunParameters run, std::int64_t task, std::span<const std::byte> snapshot,
               std::shared_ptr<ObstacleArrays> arrays)
    : run_parameters_(std::move(run)),
      snapshot_(snapshot.begin(), snapshot.end()),
      arrays_(std::move(arrays)),
      row_(begun_row(run_parameters_, task)) {}

/// Restores the run from the snapshot, if a run with these parameters can have written it. Otherwise, for
/// instance if another version wrote the snapshot, the run restarts; the result is the same.
FamilyRun RunJob::start() {
  const std::shared_ptr<const ObstacleArray> obstacles = arrays_->get(run_parameters_);
  if (!snapshot_.empty()) try {
      FamilyRun resumed = FamilyRun::resume(run_parameters_, obstacles, snapshot_);
      RunRow row = row_;
      record_interrupted(resumed, row);
      why_restarted_ = fault_of(row);
      if (why_restarted_.empty()) return resumed;
    } catch (const Error& error) {
      why_restarted_ = error.what();
    }
  return {run_parameters_, obstacles};
}

bool RunJob::advance() {
  const Clock::time_point begin = Clock::now();
  const double processor_begin = processor_seconds();
  try {
    if (!run_) run_ = std::make_unique<FamilyRun>(start());
    while (!over_ && Clock::now() - begin < slice) over_ = run_->advance(checks_per_look_at_the_clock);
  } catch (const std::exception& error) {
    over_ = true;
    RunResult failure;
    if (run_) failure = run_->result();
    failure.status = RunStatus::failed;
    failure.failed_by = FailedBy::crash;
    failure.message = error.what();
    record(failure, row_);
    run_.reset();
  }
  // Clocks of simulated time, and of some virtual machines, may jump back.
  wall_seconds_ += std::max(0.0, std::chrono::duration<double>(Clock::now() - begin).count());
  processor_seconds_ += std::max(0.0, processor_seconds() - processor_begin);
  return over_;
}

RunRow RunJob::row() const {
  RunRow row = row_;
  if (run_) record(run_->result(), row);
  if (run_ && over_) row.family = run_->members();
  if (!over_) row.status = RunStatus::interrupted;
  if (row.status != RunStatus::failed) row.message = why_restarted_;
  row.wall_seconds = wall_seconds_;
  row.processor_seconds = processor_seconds_;
  return row;
}

JobFactory run_jobs(const Plan& plan) {
  return [&plan, arrays = std::make_shared<ObstacleArrays>()](std::int64_t task,
                                                              std::span<const std::byte> snapshot) {
    return std::make_unique<RunJob>(plan.task(task), task, snapshot, arrays);
  };
}

}  // namespace clog::sweep

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
void record_interrupted(const DropletRun& run, RunRow& row) {
  RunResult result = run.result();
  result.status = RunStatus::interrupted;
  record(result, row);
}

/// Restores a run from the snapshot, if a run with these parameters can have written it. Otherwise, for
/// instance if another version has written the snapshot, the run restarts, with the same result.
/// @param row  of the run, without results
DropletRun start(const RunParameters& run, RunRow row, std::span<const std::byte> snapshot,
                 ObstacleArrays& arrays) {
  const std::shared_ptr<const ObstacleArray> obstacles = arrays.get(run);
  if (!snapshot.empty()) try {
      DropletRun resumed = DropletRun::resume(run, obstacles, snapshot);
      record_interrupted(resumed, row);
      if (fault_of(row).empty()) return resumed;
    } catch (const Error&) {
    }
  return {run, obstacles};
}

}  // namespace

RunJob::RunJob(RunParameters run, std::int64_t task, std::span<const std::byte> snapshot,
               std::shared_ptr<ObstacleArrays> arrays)
    : run_parameters_(std::move(run)),
      snapshot_(snapshot.begin(), snapshot.end()),
      arrays_(std::move(arrays)),
      row_(describe(run_parameters_)) {
  row_.task = task;
}

bool RunJob::advance() {
  const Clock::time_point begin = Clock::now();
  const double processor_begin = processor_seconds();
  try {
    if (!run_) run_ = std::make_unique<DropletRun>(start(run_parameters_, row_, snapshot_, *arrays_));
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
  // Clocks of simulated time, and of some virtual machines, may step back.
  wall_seconds_ += std::max(0.0, std::chrono::duration<double>(Clock::now() - begin).count());
  processor_seconds_ += std::max(0.0, processor_seconds() - processor_begin);
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

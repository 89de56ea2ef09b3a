#pragma once

#include <memory>
#include <string>

#include "clog/core/run/family.hpp"
#include "clog/sweep/job.hpp"
#include "clog/sweep/obstacle_arrays.hpp"
#include "clog/sweep/plan.hpp"

namespace clog::sweep {

/// A run as a job.
class RunJob final : public Job {
 public:
  /// @param run       resolved
  /// @param snapshot  a snapshot of the same task; if it cannot be used, the run restarts
  /// @param arrays    source of the run's obstacles
  RunJob(RunParameters run, std::int64_t task, std::span<const std::byte> snapshot = {},
         std::shared_ptr<ObstacleArrays> arrays = std::make_shared<ObstacleArrays>());

  bool advance() override;
  RunRow row() const override;
  std::vector<std::byte> snapshot() const override { return run_ ? run_->snapshot() : snapshot_; }

 private:
  RunParameters run_parameters_;
  std::vector<std::byte> snapshot_;
  std::shared_ptr<ObstacleArrays> arrays_;
  std::unique_ptr<FamilyRun> run_;  // made at the first advance(), because the release may fail
  RunRow row_;
  std::string why_restarted_;  // why the snapshot cannot be used; empty if it can be used
  double wall_seconds_ = 0, processor_seconds_ = 0;
  bool over_ = false;

  FamilyRun start();
};

/// @param plan  must outlive the jobs
JobFactory run_jobs(const Plan& plan);

}  // namespace clog::sweep

#pragma once

#include <memory>

#include "clog/core/systems.hpp"
#include "clog/sweep/job.hpp"
#include "clog/sweep/plan.hpp"

namespace clog::sweep {

/// A run of a plan as a job.
class RunJob final : public Job {
 public:
  RunJob(const Plan& plan, std::int64_t task);

  bool advance() override;
  RunRow row() const override;

 private:
  RunParameters run_parameters_;
  std::unique_ptr<DropletRun> run_;  // made at the first advance(): the release may fail
  RunRow row_;
  double wall_seconds_ = 0;
  bool over_ = false;
};

/// @param plan  must outlive the jobs
JobFactory run_jobs(const Plan& plan);

}  // namespace clog::sweep

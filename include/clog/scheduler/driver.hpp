#pragma once

#include <chrono>
#include <limits>
#include <string>

#include "clog/results/seed_rule.hpp"
#include "clog/results/sweep_state.hpp"
#include "clog/scheduler/communicator.hpp"
#include "clog/scheduler/log.hpp"
#include "clog/scheduler/scheduler.hpp"
#include "clog/sweep/job.hpp"
#include "clog/sweep/plan.hpp"

namespace clog::scheduler {

struct DriverOptions {
  std::string output;
  scheduler::MasterComputes master_computes = scheduler::MasterComputes::automatic;
  std::chrono::milliseconds report_interval{10'000};
  double max_hours = std::numeric_limits<double>::infinity();
  Log::Level log = Log::Level::normal;
};

/// Rank 0 calls this for a sweep, while the other ranks call follow_sweep(). Connects the scheduler with the
/// state of the sweep, the log and the progress line. Returns the exit code.
/// @param rule  requests more of the plan's tasks when the requested tasks are over; nullptr: no further
/// tasks
int drive_sweep(const scheduler::Communicator& ranks, const DriverOptions& options, const sweep::Plan& plan,
                const sweep::JobFactory& make_job, results::SweepState& state, results::SeedRule* rule);

/// All ranks except rank 0 call this for a sweep.
void follow_sweep(const scheduler::Communicator& ranks, const sweep::JobFactory& make_job,
                  std::chrono::milliseconds report_interval);

}  // namespace clog::scheduler

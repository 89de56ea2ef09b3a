#pragma once

#include <chrono>
#include <limits>
#include <optional>
#include <string>

#include "clog/campaign/ledger.hpp"
#include "clog/campaign/seed_rule.hpp"
#include "clog/conduct/log.hpp"
#include "clog/parallel/communicator.hpp"
#include "clog/parallel/scheduler.hpp"
#include "clog/sweep/job.hpp"
#include "clog/sweep/plan.hpp"

namespace clog::conduct {

struct LeadOptions {
  std::string output;
  parallel::MasterComputes master_computes = parallel::MasterComputes::automatic;
  std::chrono::milliseconds report_interval{10'000};
  double max_hours = std::numeric_limits<double>::infinity();
  Log::Level log = Log::Level::normal;
};

/// Rank 0's part of a sweep, while the other ranks are in follow_sweep(): connects the scheduler with the
/// ledger, the log and the progress line. Returns the exit code.
/// @param rule  adds tasks in further rounds, if there is one
int lead_sweep(const parallel::Communicator& ranks, const LeadOptions& options, const sweep::Plan& plan,
               const sweep::JobFactory& make_job, campaign::Ledger& ledger, campaign::SeedRule* rule);

/// The part of the other ranks.
void follow_sweep(const parallel::Communicator& ranks, const sweep::JobFactory& make_job,
                  std::chrono::milliseconds report_interval);

}  // namespace clog::conduct

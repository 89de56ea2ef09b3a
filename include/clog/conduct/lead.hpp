#pragma once

#include <chrono>
#include <functional>
#include <limits>
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

/// Makes the jobs of a rank from the text of an Assignment.
using JobsOf = std::function<sweep::JobFactory(const std::string& assignment)>;

/// Rank 0's part of a sweep, while the other ranks are in follow_sweep(): connects the scheduler with the
/// ledger, the log and the progress line. Returns the exit code.
/// @param assignment  of all ranks, as text
/// @param rule  which requests more of the plan's tasks when those requested are over; nullptr: none
int lead_sweep(const parallel::Communicator& ranks, const LeadOptions& options, const sweep::Plan& plan,
               const JobsOf& jobs_of, const std::string& assignment, campaign::Ledger& ledger,
               campaign::SeedRule* rule);

/// The part of the other ranks.
void follow_sweep(const parallel::Communicator& ranks, const JobsOf& jobs_of, const std::string& assignment);

}  // namespace clog::conduct

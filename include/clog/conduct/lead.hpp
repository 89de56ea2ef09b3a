#pragma once

#include <chrono>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "clog/campaign/ledger.hpp"
#include "clog/campaign/round_rule.hpp"
#include "clog/campaign/seed_rule.hpp"
#include "clog/conduct/log.hpp"
#include "clog/parallel/communicator.hpp"
#include "clog/parallel/scheduler.hpp"
#include "clog/sweep/job.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/points.hpp"
#include "clog/sweep/settings.hpp"

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

/// A sweep with one more round.
struct GrownSweep {
  const sweep::Plan* plan;
  const sweep::Settings* settings;
  std::string assignment;  ///< text of the Assignment of all ranks
};
/// What may enlarge a sweep when all its tasks are over: a rule that wants more of the plan's tasks, or a
/// refiner, for whose rounds the plan itself grows; or nothing.
struct Growth {
  campaign::SeedRule* rule = nullptr;
  campaign::RoundRule* refiner = nullptr;
  /// Makes the sweep grow by a round of the refiner. The returned pointers stay valid until the sweep ends.
  std::function<GrownSweep(const sweep::Points& round)> grow;

  bool is_possible() const { return rule != nullptr || refiner != nullptr; }
};

/// Rank 0's part of a sweep, while the other ranks are in follow_sweep(): connects the scheduler with the
/// ledger, the log and the progress line. Returns the exit code.
/// @param assignment  of all ranks, as text
int lead_sweep(const parallel::Communicator& ranks, const LeadOptions& options, const sweep::Plan& plan,
               const JobsOf& jobs_of, const std::string& assignment, campaign::Ledger& ledger,
               const Growth& growth);

/// The part of the other ranks.
void follow_sweep(const parallel::Communicator& ranks, const JobsOf& jobs_of, const std::string& assignment);

}  // namespace clog::conduct

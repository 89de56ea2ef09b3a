#pragma once

#include <string>

#include "clog/results/progress.hpp"
#include "clog/results/sweep_state.hpp"
#include "clog/scheduler/machine_trust.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/run_row.hpp"

namespace clog::scheduler {

/// Prints, before a sweep, which runs are known and which remain. @param may_grow  runs may be added later
void announce(const std::string& output, const sweep::Plan& plan, const results::SweepState& state,
              bool may_grow, int num_ranks);

/// Prints the events of a sweep, one line each: 12:03:17 task 17 rank 3: clogged at 4.21 sigma after 812 t0
/// (Gamma=0.3, gap=0.2, seed 4)
class Log {
 public:
  enum class Level {
    quiet,   ///< only events that a user should act on, such as a machine that is set aside
    normal,  ///< also failures and the reason for a stop
    verbose  ///< also every task that starts or ends
  };
  enum class From { release, snapshot };
  enum class Then { over, tried_again };

  /// @param progress  the progress line; log lines are printed above it
  Log(results::Progress& progress, Level level) : progress_(progress), level_(level) {}

  void started(const sweep::RunRow& row, From from);
  /// @param row  row of the task; its message says why the task cannot use its snapshot
  void restarted(const sweep::RunRow& row);
  /// Call this when a task has ended, failed or not, or was interrupted.
  void ended(const sweep::RunRow& row);
  void failed(const sweep::RunRow& row, Then then);
  void failure_withdrawn(const sweep::RunRow& row, const std::string& machine);
  void set_aside(const MachineTrust::Suspect& machine);
  void stopping(const std::string& reason);

 private:
  results::Progress& progress_;
  Level level_;

  void say(const std::string& text);
};

}  // namespace clog::scheduler

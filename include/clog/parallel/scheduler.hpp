#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "clog/parallel/communicator.hpp"
#include "clog/parallel/rank_trust.hpp"
#include "clog/parallel/task_order.hpp"
#include "clog/sweep/job.hpp"
#include "clog/sweep/messages.hpp"

namespace clog::parallel {

enum class MasterComputes { automatic, yes, no };

using sweep::Report;
using sweep::Start;

/// What rank 0 is told while a sweep runs, and asked. Called on rank 0 only, between slices of its own work.
struct SweepEvents {
  std::function<Start(std::int64_t task, int rank)> started = [](std::int64_t, int) { return Start(); };
  /// Of a task that runs on; its row says `running`. Now and then.
  std::function<void(const Report&)> progressed = [](const Report&) {};
  /// Every task that was started ends here once for each attempt; `interrupted` after a stop.
  std::function<void(const Report&)> ended = [](const Report&) {};
  /// Of a task that ended as `failed`: is it to be tried again?
  std::function<bool(const sweep::RunRow&)> tries_again = [](const sweep::RunRow&) { return false; };
  /// Of a task that ended as `failed`: it may have been the rank's fault (see RankTrust), the attempt does
  /// not count. The task is done once more, whatever tries_again() said.
  std::function<void(std::int64_t task)> failure_withdrawn = [](std::int64_t) {};
  /// A rank gets no more tasks; the row, of rank and host, is that of the last task that failed on it.
  std::function<void(const sweep::RunRow& failed)> set_aside = [](const sweep::RunRow&) {};
  /// About every 0.1 s; less often while this rank samples an array or releases a droplet (a second, in large
  /// boxes).
  std::function<void()> idle = [] {};
  /// Should the sweep stop now? Running tasks are then ended as interrupted, no more are handed out.
  std::function<bool()> stop_requested = [] { return false; };
};

/// Does rank 0 compute? With `automatic` up to 16 ranks: beyond that one rank more or less is not worth the
/// delay that its slices put between a worker and its next task.
bool computes(int num_ranks, MasterComputes choice);

/// What rank 0 knows of a sweep's tasks and ranks. It lasts over all rounds of a sweep: who was set aside
/// stays so, and measured run times go on to count.
struct Schedule {
  /// @param first  tasks of the first round
  Schedule(TaskOrder first, int num_ranks, bool with_master);

  TaskOrder tasks;
  bool master_computes;
  RankTrust trust;
  std::unordered_map<int, sweep::RunRow> last_failures;  ///< by rank
};

enum class SweepEnd {
  complete,      ///< all tasks were handed out
  stopped,       ///< as stop_requested() said
  no_rank_left,  ///< every rank was set aside
};

/// Works through all tasks with all ranks, a round of a sweep; collective.
///
/// Rank 0 hands out one task at a time, since tasks differ a thousandfold in length, and gathers the rows.
/// Rows do not depend on the order of the tasks. A task that failed is tried again on another rank, if there
/// is one, before others are begun. A rank on which everything fails is set aside: see RankTrust. If it
/// computes, it does so in slices between polls. Nobody spins: who has nothing to do sleeps, longer and
/// longer, up to a few milliseconds.
/// A task that is stopped has two seconds to say how far it is; else its last report is taken.
/// @param schedule  matters on rank 0
/// @param make_job  called on the rank that works on the task
/// @param report_interval  time between two reports of a running task
/// @return how it ended (rank 0; complete elsewhere)
SweepEnd run_tasks(const Communicator& ranks, Schedule& schedule, const sweep::JobFactory& make_job,
                   const SweepEvents& events,
                   std::chrono::milliseconds report_interval = std::chrono::seconds(10));

}  // namespace clog::parallel

#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "clog/scheduler/communicator.hpp"
#include "clog/scheduler/machine_trust.hpp"
#include "clog/scheduler/task_order.hpp"
#include "clog/sweep/job.hpp"
#include "clog/sweep/messages.hpp"

namespace clog::scheduler {

enum class MasterComputes { automatic, yes, no };

using sweep::Report;
using sweep::Start;

/// Callbacks by which the scheduler informs and queries its caller during a sweep. They are called on rank 0
/// only, between slices of rank 0's own work.
struct SweepEvents {
  std::function<Start(std::int64_t task, int rank)> started = [](std::int64_t, int) { return Start(); };
  /// Called from time to time for a running task; the status of its row is `running`.
  std::function<void(const Report&)> progressed = [](const Report&) {};
  /// Called at the end of each attempt of a started task; after a stop the status is `interrupted`.
  std::function<void(const Report&)> ended = [](const Report&) {};
  /// Returns whether a task that ended as `failed` should be tried again.
  std::function<bool(const sweep::RunRow&)> tries_again = [](const sweep::RunRow&) { return false; };
  /// Called for a task that `failed` if this machine may be at fault (see MachineTrust). The attempt does not
  /// count, and the task is tried once more, whatever tries_again() has returned.
  std::function<void(std::int64_t task, const std::string& machine)> failure_withdrawn =
      [](std::int64_t, const std::string&) {};
  /// Called when a machine is set aside, because it is at fault for its failures. It gets no more tasks.
  std::function<void(const MachineTrust::Suspect&)> set_aside = [](const MachineTrust::Suspect&) {};
  /// Called about every 0.1 s, but less often while rank 0 samples an array or releases a droplet, which may
  /// take a second in a large box.
  std::function<void()> idle = [] {};
  /// Returns whether the sweep should stop now. If so, running tasks end as `interrupted`, and no further
  /// tasks are handed out.
  std::function<bool()> stop_requested = [] { return false; };
};

/// Whether rank 0 computes. `automatic`: only with up to 16 ranks. With more ranks, rank 0 would contribute
/// little, and while it computes, workers would wait for their next tasks.
bool computes(int num_ranks, MasterComputes choice);

/// Rank 0's state of a sweep's tasks and machines. It is kept for all rounds: machines that were set aside
/// stay set aside, and measured run times remain in use.
struct Schedule {
  /// @param first  tasks of the first round
  /// @param hosts  hosts of all ranks, by rank; on ranks other than 0, an empty list
  Schedule(TaskOrder first, const std::vector<std::string>& hosts, bool with_master);

  TaskOrder tasks;
  bool master_computes;
  MachineTrust trust;
};

enum class SweepEnd {
  complete,         ///< all tasks were handed out
  stopped,          ///< stop_requested() returned true
  no_machine_left,  ///< every machine was set aside
};

/// Computes all tasks of a round on all ranks; every rank must call this.
///
/// Rank 0 hands out one task at a time, because the run times of tasks differ by a factor of a thousand. It
/// also gathers the rows. Rows do not depend on the order of the tasks. A task that failed is tried again on
/// another machine, if there is one, before new tasks start. A machine on which all tasks fail is set aside:
/// see MachineTrust. If rank 0 computes, it does so in slices between two polls for messages. No rank spins:
/// an idle rank sleeps, with a backoff of up to a few milliseconds. A stopped task has two seconds to report
/// its progress; after this time its previous report is used.
/// @param schedule  used on rank 0 only
/// @param make_job  called on the rank that works on the task
/// @param report_interval  time between two reports of a running task
/// @return how the round ended, on rank 0; `complete` on the other ranks
SweepEnd run_tasks(const Communicator& ranks, Schedule& schedule, const sweep::JobFactory& make_job,
                   const SweepEvents& events,
                   std::chrono::milliseconds report_interval = std::chrono::seconds(10));

}  // namespace clog::scheduler

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "clog/store/journal.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/plan.hpp"

namespace clog::results {

/// All runs of a sweep, in memory. Only the owner's thread changes them.
struct SweepRuns {
  using Entry = store::Journal::Entry;
  using Entries = std::vector<std::unique_ptr<Entry>>;

  std::int64_t attempts;             ///< number of attempts for a crashing run, over all sessions
  Entries by_task = {};              ///< nullptr for a task that has not begun
  Entries others = {};               ///< runs that are in the file, but not in this plan
  mutable std::mutex changing = {};  ///< protects rows that a publication may be reading

  /// The run of a task; nullptr if it has not begun.
  Entry* find(std::int64_t task) const {
    return task < std::ssize(by_task) ? by_task[static_cast<std::size_t>(task)].get() : nullptr;
  }
  std::unique_ptr<Entry>& place_of(std::int64_t task) {
    if (task >= std::ssize(by_task)) by_task.resize(static_cast<std::size_t>(task) + 1);
    return by_task[static_cast<std::size_t>(task)];
  }
  std::vector<const Entry*> all() const {
    std::vector<const Entry*> runs;
    runs.reserve(by_task.size() + others.size());
    for (const Entries* entries : {&by_task, &others})
      for (const auto& run : *entries)
        if (run) runs.push_back(run.get());
    return runs;
  }
  bool tries_again(const sweep::RunRow& failed) const {
    return sweep::may_succeed_later(failed) && failed.attempt < attempts;
  }
  bool is_over(const sweep::RunRow& row) const {
    return !sweep::is_unfinished(row.status) && !tries_again(row);
  }
};

/// Resets a run to its release, except its parameters and its cost so far.
inline void restart(sweep::RunRow& row) {
  RunResult nothing;
  nothing.status = RunStatus::interrupted;
  sweep::record(nothing, row);
}

/// A copy of a run, which costs nothing.
inline std::unique_ptr<SweepRuns::Entry> copy_of(const SweepRuns::Entry& twin) {
  auto copy = std::make_unique<SweepRuns::Entry>(twin);
  copy->row.wall_seconds = copy->row.processor_seconds = 0;
  return copy;
}

/// A sweep that may have earlier sessions.
struct Resumption {
  const std::string& path;
  const sweep::Plan& plan;
  const sweep::Settings& settings;
  std::int64_t num_wanted;  ///< number of tasks, from the start of the plan, that are requested
};

/// Adopts the runs of the table and the journal of earlier sessions, and gives them their tasks. Returns the
/// number of physically impossible rows, which are left out. @throws Error if the table or the journal
/// belongs to another sweep
std::int64_t adopt(const Resumption& sweep, store::SweepFile table,
                   std::vector<store::Journal::Entry> records, SweepRuns& runs);

}  // namespace clog::results

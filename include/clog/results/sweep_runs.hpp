#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "clog/store/journal.hpp"
#include "clog/sweep/run_row.hpp"

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
inline void reset_to_release(sweep::RunRow& row) {
  RunResult nothing;
  nothing.status = RunStatus::interrupted;
  sweep::record(nothing, row);
}

/// A copy of a run that has cost no time.
inline std::unique_ptr<SweepRuns::Entry> copy_without_costs(const SweepRuns::Entry& twin) {
  auto copy = std::make_unique<SweepRuns::Entry>(twin);
  copy->row.wall_seconds = copy->row.processor_seconds = 0;
  return copy;
}

}  // namespace clog::results

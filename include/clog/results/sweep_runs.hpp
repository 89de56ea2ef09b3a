#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "clog/store/journal.hpp"

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
  Entry* find(std::int64_t task) const;
  std::unique_ptr<Entry>& place_of(std::int64_t task);
  std::vector<const Entry*> all() const;

  bool tries_again(const sweep::RunRow& failed) const;
  bool is_over(const sweep::RunRow& row) const;
  /// The row that readers see: a run that will be tried again is not failed yet, and its failed attempt has
  /// no distance.
  sweep::RunRow published(const sweep::RunRow& row) const;
};

/// Resets a run to its release, except its parameters and its cost so far.
void restart(sweep::RunRow& row);
/// A copy of a run, which costs nothing.
std::unique_ptr<SweepRuns::Entry> copy_of(const SweepRuns::Entry& twin);

}  // namespace clog::results

#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "clog/results/group_table.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/results/time_left.hpp"
#include "clog/store/run_table.hpp"

namespace clog::results {

/// Progress of a sweep, and its results so far.
struct Status {
  RunCount runs;
  std::map<RunStatus, std::int64_t> by_status;
  std::map<std::string, std::int64_t> by_outcome;  ///< see outcome_of()
  bool is_alive = false;
  double core_hours = 0;
  TimeLeft left;
  std::string stopping_rule;  ///< empty: none
  std::vector<Group> groups;

  std::int64_t count(RunStatus status) const {
    const auto found = by_status.find(status);
    return found == by_status.end() ? 0 : found->second;
  }
  std::int64_t num_unfinished() const { return count(RunStatus::running) + count(RunStatus::interrupted); }
  std::int64_t num_finished() const {
    std::int64_t sum = -num_unfinished();
    for (const auto& [status, number] : by_status) sum += number;
    return sum;
  }
};

/// The status of a sweep from its file, which the sweep may still be writing. Runs in progress are censored
/// at their present distance. Finished runs alone would give too short lengths, because runs that clog early
/// finish first. @throws Error if the file lacks the description of its sweep
Status status_of(const std::string& path, const store::SweepFile& file, double confidence);

/// The status as printed text.
std::string to_text(const std::string& path, const Status& status, double confidence,
                    SharedParameters shared);
std::string to_json(const Status& status);

}  // namespace clog::results

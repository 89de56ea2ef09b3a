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

/// How far a sweep is, and what it has found so far.
struct Status {
  RunCount runs;
  std::map<RunStatus, std::int64_t> by_status;
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

/// Status from a sweep's file, also while it is written. Runs in progress count as not clogged so far, at the
/// distance they have reached: finished runs alone would give too short lengths, since runs that clog early
/// finish first.
/// @throws Error if the file does not say what its sweep is
Status status_of(const std::string& path, const store::SweepFile& file, double confidence);

/// The status as text for people.
std::string to_text(const std::string& path, const Status& status, double confidence,
                    SharedParameters shared);
std::string to_json(const Status& status, double confidence);

}  // namespace clog::results

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "clog/sweep/run_row.hpp"

namespace clog::sweep {

/// A task that is computed in slices. Between slices, its process can handle messages.
class Job {
 public:
  virtual ~Job() = default;
  /// Works for some milliseconds. Returns whether the task is over. An error of the task ends the task with a
  /// row of status `failed`; advance() does not throw.
  virtual bool advance() = 0;
  /// Returns whether row() and snapshot() have the task's present state. Never waits. If another process
  /// computes the job, the first call sends a request to that process and returns false. advance() receives
  /// the answer, and the next call of refresh() returns true.
  virtual bool refresh() { return true; }
  /// The task's row. Until the task is over, the row has the status `interrupted`. If the task could not use
  /// its snapshot and restarted, the message says why. If the task failed, the message gives only the reason
  /// of the failure. Rank 0 stores only messages about failures.
  virtual RunRow row() const = 0;
  /// A snapshot from which another job of this task can resume; empty if there is none yet.
  virtual std::vector<std::byte> snapshot() const { return {}; }
};

/// Starts a task, or resumes it from a snapshot that is not empty.
using JobFactory =
    std::function<std::unique_ptr<Job>(std::int64_t task, std::span<const std::byte> snapshot)>;

}  // namespace clog::sweep

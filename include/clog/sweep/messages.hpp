#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "clog/sweep/run_row.hpp"

/// Messages between the ranks of a sweep and the processes that compute for them.
namespace clog::sweep {

/// The start of a task.
struct Start {
  std::vector<std::byte> snapshot;  ///< empty: the task starts at the release
  std::int64_t attempt = 1;
};

/// Progress of a task: the task's row and, if there is one, a snapshot from which the task can resume. A
/// sweep's journal consists of reports, too. In the bytes of a report, the row is followed by its family if
/// the run has ended with one, otherwise by the snapshot.
struct Report {
  RunRow row;
  std::vector<std::byte> snapshot;
};

std::vector<std::byte> to_bytes(const Report& report);
/// @param bytes  result of to_bytes() of this version. @throws Error if the row has a value that no row can
/// hold
Report report_from(std::span<const std::byte> bytes);

}  // namespace clog::sweep

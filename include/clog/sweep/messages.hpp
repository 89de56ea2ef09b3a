#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "clog/sweep/run_row.hpp"

/// What those who work on a sweep tell each other: ranks, and the processes that compute for them.
namespace clog::sweep {

/// Where a task begins.
struct Start {
  std::vector<std::byte> snapshot;  ///< empty: at its release
  std::int64_t attempt = 1;
};

/// How far a task has come: its row, and a snapshot to go on from, if there is one. A sweep's journal is made
/// of them, too.
struct Report {
  RunRow row;
  std::vector<std::byte> snapshot;
};

std::vector<std::byte> to_bytes(const Report& report);
/// @param bytes  of to_bytes() of this version
Report report_from(std::span<const std::byte> bytes);

}  // namespace clog::sweep

#pragma once

#include <filesystem>

namespace clog::diagnostics {

// What the host leaves to this process. Containers and batch systems may grant less than there is, through
// control groups (Linux, Documentation/admin-guide/cgroup-v2.rst): the tightest of the process's own group
// and all groups around it counts. Limits of version 1 are not seen.

/// Cores that the control groups grant to all of their processes, as time per period; 0: no limit.
/// @param root  holds proc and sys
double granted_cores(const std::filesystem::path& root = "/");

/// Memory still available [bytes], on the host and in the control groups; 0 if unknown. Inactive page cache
/// counts as available, since the kernel evicts it first.
/// @param root  holds proc and sys
double available_memory(const std::filesystem::path& root = "/");

/// Raises the limit on open files if it is low, as far as that is allowed. MPI needs about twenty, and dies
/// of fewer with a crash or messages of its own.
/// @throws Error if it stays too low
void require_open_files();

}  // namespace clog::diagnostics

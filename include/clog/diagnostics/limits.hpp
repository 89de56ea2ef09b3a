#pragma once

#include <filesystem>

namespace clog::diagnostics {

// Resources of the host that this process may use. Containers and batch systems may grant only a part of the
// host, through control groups (Linux, Documentation/admin-guide/cgroup-v2.rst). The tightest limit of the
// process's own group and all enclosing groups counts. Limits of version 1 are ignored.

/// Number of cores that the control groups grant to all processes in them together. It is the processor time
/// that these processes may use per period, divided by the period. 0 if there is no limit.
/// @param root  folder that contains proc and sys
double granted_cores(const std::filesystem::path& root = "/");

/// Memory still available [bytes], on the host and in the control groups; 0 if unknown. Inactive page cache
/// counts as available, since the kernel evicts it first.
/// @param root  folder that contains proc and sys
double available_memory(const std::filesystem::path& root = "/");

/// If the limit on open files is low, raises it as far as allowed. MPI needs about twenty open files; with
/// fewer, MPI crashes or prints messages of its own. @throws Error if the limit stays too low
void require_open_files();

}  // namespace clog::diagnostics

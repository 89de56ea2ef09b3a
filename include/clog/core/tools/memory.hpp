#pragma once

#include <cstddef>
#include <string>

namespace clog {

/// Checks for memory before a library needs it. HDF5 and MPI may crash without it, for instance under ulimit.
/// @param purpose  of it, as in "cannot PURPOSE"; @param bytes  that must still be free for this process
/// @throws Error if they are not
void require_memory(const std::string& purpose, std::size_t bytes);

}  // namespace clog

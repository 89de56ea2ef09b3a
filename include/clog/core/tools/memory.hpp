#pragma once

#include <cstddef>
#include <string>

namespace clog {

/// Checks that a library will find the memory that it needs. HDF5 and MPI may crash without it, for instance
/// under ulimit.
/// @param purpose  what the memory is for, as in "cannot PURPOSE"
/// @param bytes  memory that must still be free for this process
/// @throws Error if it is not
void require_memory(const std::string& purpose, std::size_t bytes);

}  // namespace clog

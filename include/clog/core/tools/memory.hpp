#pragma once

#include <cstddef>
#include <string>

namespace clog {

/// Checks that enough memory is free for a library. HDF5 and MPI may crash if memory runs out, for instance
/// under ulimit.
/// @param purpose  what the memory is for, as in "cannot PURPOSE"
/// @param bytes  memory that must still be free for this process
/// @throws Error if less memory is free
void require_memory(const std::string& purpose, std::size_t bytes);

}  // namespace clog

#pragma once

#include <cstddef>
#include <string>

namespace clog {

/// Asks for memory before a library takes it. HDF5 and MPI do not always survive that there is none, as where
/// ulimit has set a bound.
/// @param purpose  of it, as in "cannot PURPOSE"; @param bytes  that must still be free for this process
/// @throws Error if they are not
void require_memory(const std::string& purpose, std::size_t bytes);

}  // namespace clog

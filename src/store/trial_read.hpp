#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

namespace clog::store {

/// Reads a file without a whole seal in a child process first, because HDF5 may crash or never end on damaged
/// metadata. The outcome for the last bytes is kept, so that they are tried once. Errors thrown by `read` do
/// not count: they come again in the reading itself.
/// @param image  all bytes of the file, which `read` reads
/// @throws Error naming the path if the child process dies
void try_in_child(std::span<const std::byte> image, const std::string& path,
                  const std::function<void()>& read);

}  // namespace clog::store

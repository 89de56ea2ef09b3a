#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

namespace clog::store {

/// Reads a file without a valid seal first in a child process, because HDF5 may crash or loop for ever on
/// damaged metadata. Stores the outcome for the last file, so that the same bytes are tried only once.
/// Ignores errors that `read` throws, because the actual read throws them again.
/// @param image  all bytes of the file, which `read` reads
/// @throws Error naming the path if the child process crashes
void try_in_child(std::span<const std::byte> image, const std::string& path,
                  const std::function<void()>& read);

}  // namespace clog::store

#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

namespace clog::store {

/// If a file has no valid seal, first reads it in a child process, because HDF5 may crash or loop for ever on
/// damaged metadata. Remembers the outcome for the last file, so that the same bytes are tried only once.
/// Ignores errors that `read` throws, because the later read in this process throws them again.
/// @param image  all bytes of the file, which `read` reads
/// @throws Error naming the path if the child process crashes
void try_in_child(std::span<const std::byte> image, const std::string& path,
                  const std::function<void()>& read);

}  // namespace clog::store

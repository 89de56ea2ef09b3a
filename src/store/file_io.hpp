#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "clog/core/tools/error.hpp"

/// Files, by their descriptors.
namespace clog::store {

enum class FileAction { create, write, read };

/// A system call on a file failed.
class FileError : public Error {
 public:
  FileError(FileAction action, const std::string& path, std::error_code reason);
};

/// The reason why the last system call failed. Call this directly after the failure.
inline std::error_code last_error() { return {errno, std::generic_category()}; }

/// @throws FileError if `reason` is an error
inline void check(std::error_code reason, FileAction action, const std::string& path) {
  if (reason) throw FileError(action, path, reason);
}

/// Saves a file to disk. Returns the reason if this fails.
std::error_code sync(int descriptor);

/// Locks an open file for this process until it is closed. Returns false if another process holds the lock.
/// @throws Error if the file system has no locks; users can allow such file systems with
/// HDF5_USE_FILE_LOCKING=FALSE, a variable of HDF5
bool try_lock(int descriptor, const std::string& path);

/// Size of an open file [bytes]. @throws FileError naming the path; the functions below throw it, too
std::size_t size_of(int descriptor, const std::string& path);

/// All bytes of a file. If somebody truncates the file during the call, the result has fewer bytes than
/// size_of().
std::vector<std::byte> read_all(int descriptor, const std::string& path);

/// Reads `size` bytes from `place` on; fewer if the file ends earlier.
std::vector<std::byte> read_at(int descriptor, std::uint64_t place, std::size_t size,
                               const std::string& path);

/// Writes all bytes or none: an incomplete write is undone.
void write_at(int descriptor, std::span<const std::byte> bytes, std::uint64_t place, const std::string& path);

}  // namespace clog::store

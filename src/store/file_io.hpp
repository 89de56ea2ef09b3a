#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

/// Facts about files, through their descriptors.
namespace clog::store {

/// @throws Error naming the file, and the system's reason if there is one
void check(bool succeeded, const std::string& what, const std::string& path);

/// Brings a file to the disk, whatever signals come. Returns whether that succeeded.
bool sync(int descriptor);

/// Locks an open file for this process alone, until it is closed. Returns false if another process holds the
/// lock.
/// @throws Error if the file system has no locks, unless HDF5_USE_FILE_LOCKING=FALSE, the variable of HDF5,
/// allows files without
bool try_lock(int descriptor, const std::string& path);

/// Fills the bytes from this place of the file on. @throws Error naming the path, also if the file ends
/// before
void read_at(int descriptor, std::span<std::byte> bytes, std::uint64_t place, const std::string& path);

/// Whole or not at all: what does not fit is cut off again. @throws Error naming the path
void write_at(int descriptor, std::span<const std::byte> bytes, std::uint64_t place, const std::string& path);

}  // namespace clog::store

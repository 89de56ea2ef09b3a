#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

/// What is asked of files through their descriptors.
namespace clog::store {

/// @throws Error naming the file, and the system's reason if there is one
void check(bool succeeded, const std::string& what, const std::string& path);

/// Where a symbolic link leads in the end, whether there is a file or not; other paths come back as they are.
std::string follow_links(const std::string& path);

/// Is this still the file that the path leads to? Somebody may have replaced or removed it meanwhile.
bool is_at(int descriptor, const std::string& path);

/// Brings to the disk what a file in this folder is called. Returns whether that succeeded.
bool sync_folder_of(const std::string& path);

/// Fills the bytes from this place of the file on. @throws Error naming the path, also if the file ends
/// before
void read_at(int descriptor, std::span<std::byte> bytes, std::uint64_t place, const std::string& path);

/// Whole or not at all: what does not fit is cut off again. @throws Error naming the path
void write_at(int descriptor, std::span<const std::byte> bytes, std::uint64_t place, const std::string& path);

}  // namespace clog::store

#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace clog::store {

/// Whether the bits of a file are still as clogsweep wrote them.
enum class Seal {
  whole,    ///< yes
  broken,   ///< no
  missing,  ///< unknown: another program has copied the file, or its end is lost
};

/// A line at the end of a file, after the part that HDF5 reads. It has the size and the checksum of all bytes
/// before it. Programs that only read the file ignore this line; programs that write to the file remove it.
std::string seal_of(std::span<const std::byte> content);

inline constexpr std::size_t seal_size = 64;
/// Whether the last line of a file begins like a seal.
bool has_seal_mark(std::string_view end);

/// Seal of a file's whole content.
Seal look_at_seal(std::span<const std::byte> file);

}  // namespace clog::store

#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace clog::store {

/// Whether a file has the bits with which it was written.
enum class Seal {
  whole,    ///< yes
  broken,   ///< no
  missing,  ///< not known: the file is a copy made by another program, or has lost its end
};

/// A line at the end of a file, after the part that HDF5 reads: the size and the checksum of all before it.
/// Programs that only read the file ignore this line; programs that write to the file remove it.
std::string seal_of(std::span<const std::byte> content);

inline constexpr std::size_t seal_size = 64;
/// Whether the last line of a file begins like a seal.
bool has_seal_mark(std::string_view end);

/// Seal of a file's whole content.
Seal look_at_seal(std::span<const std::byte> file);

}  // namespace clog::store

#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace clog::store {

/// Whether a file is as it was written, bit for bit.
enum class Seal {
  whole,    ///< yes
  broken,   ///< no
  missing,  ///< not known: a copy made by another program, or one that lost its end
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

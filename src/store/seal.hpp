#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace clog::store {

/// Is a file, every bit of it, as it was written?
enum class Seal {
  whole,    ///< yes
  broken,   ///< no
  missing,  ///< not known: a copy made by another program, or one that lost its end
};

/// A line that goes to the end of a file, behind what HDF5 reads: the size and the checksum of all before it.
/// Other programs pass over it; those that write to the file cut it off.
std::string seal_of(std::span<const std::byte> content);

inline constexpr std::size_t seal_size = 64;
/// Does the last line of a file begin as a seal does?
bool has_seal_mark(std::string_view end);

/// Seal of a file's whole content.
Seal look_at_seal(std::span<const std::byte> file);

}  // namespace clog::store

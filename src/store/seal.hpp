#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace clog::store {

/// Is a file, every bit of it, as it was written?
enum class Seal {
  whole,    ///< yes
  broken,   ///< no
  missing,  ///< not known: an older version, a copy made by another program, or one that lost its end
};

/// A line that goes to the end of a file, behind what HDF5 reads: the size and the checksum of all before it.
/// Other programs pass over it; those that write to the file cut it off.
std::string seal_of(std::span<const std::byte> content);

/// Seal of a file's whole content.
Seal look_at_seal(std::span<const std::byte> file);

}  // namespace clog::store

#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace clog::store {

/// CRC-32 as in zlib. It detects every single flipped bit, and any number of flipped bits within 32
/// consecutive bits.
inline std::uint32_t check_sum(std::span<const std::byte> bytes) {
  const auto* begin = reinterpret_cast<const Bytef*>(bytes.data());
  return static_cast<std::uint32_t>(crc32_z(0, begin, bytes.size()));
}
inline std::uint32_t check_sum(std::string_view text) { return check_sum(std::as_bytes(std::span(text))); }

}  // namespace clog::store

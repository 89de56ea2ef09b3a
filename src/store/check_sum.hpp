#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace clog::store {

/// CRC-32 as of zlib: no flip of a bit, nor of several within 32 that follow each other, leaves it as it was.
inline std::uint32_t check_sum(std::span<const std::byte> bytes) {
  const auto* begin = reinterpret_cast<const Bytef*>(bytes.data());
  return static_cast<std::uint32_t>(crc32_z(0, begin, bytes.size()));
}
inline std::uint32_t check_sum(std::string_view text) { return check_sum(std::as_bytes(std::span(text))); }

}  // namespace clog::store

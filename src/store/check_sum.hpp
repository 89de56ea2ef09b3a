#pragma once

#include <boost/crc.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace clog::store {

/// CRC-32 as of zlib: no flip of a bit, nor of several within 32 that follow each other, leaves it as it was.
inline std::uint32_t check_sum(std::span<const std::byte> bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}
inline std::uint32_t check_sum(std::string_view text) { return check_sum(std::as_bytes(std::span(text))); }

}  // namespace clog::store

#include "clog/core/tools/check_sum64.hpp"

#include <fmt/core.h>

#include <boost/crc.hpp>
#include <charconv>

namespace clog {

std::uint64_t check_sum64(std::span<const std::byte> bytes) {
  boost::crc_optimal<64, 0x42F0E1EBA9EA3693, 0xFFFFFFFFFFFFFFFF, 0xFFFFFFFFFFFFFFFF, true, true> sum;
  sum.process_bytes(bytes.data(), bytes.size());
  return sum.checksum();
}

std::string hexadecimal(std::uint64_t number) { return fmt::format("{:016x}", number); }

std::optional<std::uint64_t> from_hexadecimal(std::string_view text) {
  constexpr std::size_t num_digits = 16;
  std::uint64_t number = 0;
  const char* end = text.data() + text.size();
  if (text.size() != num_digits || std::from_chars(text.data(), end, number, 16).ptr != end)
    return std::nullopt;
  return number;
}

}  // namespace clog

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace clog {

/// CRC-64/XZ.
std::uint64_t check_sum64(std::span<const std::byte> bytes);
/// The number as 16 hexadecimal digits, and the inverse, which returns nullopt for any other text.
std::string hexadecimal(std::uint64_t number);
std::optional<std::uint64_t> from_hexadecimal(std::string_view text);

}  // namespace clog

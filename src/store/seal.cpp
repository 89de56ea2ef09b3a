#include "seal.hpp"

#include <fmt/core.h>

#include <string_view>

#include "check_sum.hpp"

namespace clog::store {
namespace {

constexpr std::string_view seal_mark = "\nclogsweep seal 1: crc32 ";

}  // namespace

bool has_seal_mark(std::string_view end) { return end.starts_with(seal_mark); }

std::string seal_of(std::span<const std::byte> content) {
  return fmt::format("{}{:08x} of {:020} bytes\n", seal_mark, check_sum(content), content.size());
}

Seal look_at_seal(std::span<const std::byte> file) {
  if (file.size() < seal_size) return Seal::missing;
  const std::span content = file.first(file.size() - seal_size);
  const std::string_view end(reinterpret_cast<const char*>(file.data()) + content.size(), seal_size);
  if (!has_seal_mark(end)) return Seal::missing;
  return end == seal_of(content) ? Seal::whole : Seal::broken;
}

}  // namespace clog::store

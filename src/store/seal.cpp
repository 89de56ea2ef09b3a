#include "seal.hpp"

#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string_view>

#include "check_sum.hpp"

namespace clog::store {
namespace {

constexpr std::string_view seal_mark = "\nclogsweep seal 1: crc32 ";
constexpr std::size_t seal_size = 64;

/// Where HDF5's part of a file ends, by its superblock; nothing if it is of a format that we do not write.
std::optional<std::uint64_t> end_of_hdf5(std::span<const std::byte> file) {
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  constexpr std::size_t place_of_version = 8, place_of_end = 40;
  std::uint64_t end = 0;
  if (file.size() < place_of_end + sizeof end) return std::nullopt;
  const std::string_view begin(reinterpret_cast<const char*>(file.data()), place_of_version);
  if (begin != signature || file[place_of_version] != std::byte{0}) return std::nullopt;
  std::memcpy(&end, file.data() + place_of_end, sizeof end);
  return end;
}

}  // namespace

std::string seal_of(std::span<const std::byte> content) {
  char text[seal_size + 1];
  const int written = std::snprintf(text, sizeof text, "%s%08" PRIx32 " of %020" PRIu64 " bytes\n",
                                    seal_mark.data(), check_sum(content), std::uint64_t{content.size()});
  return {text, static_cast<std::size_t>(written)};
}

Seal look_at_seal(std::span<const std::byte> file) {
  if (file.size() < seal_size) return Seal::missing;
  const std::span content = file.first(file.size() - seal_size);
  const std::string_view end(reinterpret_cast<const char*>(file.data()) + content.size(), seal_size);
  if (end == seal_of(content)) return Seal::whole;
  // Programs that copy or change a file end it where HDF5 does: what lies behind, or is not there, was
  // damaged.
  const bool ends_as_hdf5_does = end_of_hdf5(file).value_or(file.size()) == file.size();
  return ends_as_hdf5_does && !end.starts_with(seal_mark) ? Seal::missing : Seal::broken;
}

}  // namespace clog::store

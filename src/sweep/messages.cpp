#include "clog/sweep/messages.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "clog/core/tools/error.hpp"

namespace clog::sweep {
namespace {

/// The first number of a family's bytes. No snapshot begins with it. Change it whenever the bytes of a family
/// change.
constexpr std::uint64_t family_mark = 0x636c6f676d000001;

}  // namespace

std::vector<std::byte> to_bytes(const Report& report) {
  std::vector<std::byte> rest = report.snapshot;
  if (!report.row.family.empty()) {
    ByteWriter family;
    family.put(family_mark);
    save(report.row.family, family);
    rest = family.take();
  }
  std::vector<std::byte> bytes(packed_size() + rest.size());
  pack(report.row, std::span(bytes).first(packed_size()));
  std::ranges::copy(rest, bytes.begin() + static_cast<std::ptrdiff_t>(packed_size()));
  return bytes;
}

Report report_from(std::span<const std::byte> bytes) {
  UnpackedRow unpacked = unpack(bytes.first(packed_size()));
  if (!unpacked.fault.empty())
    throw Error("cannot read a row (" + unpacked.fault + "); it is of another version, or damaged");
  const std::span rest = bytes.subspan(packed_size());
  std::uint64_t mark = 0;
  try {
    ByteReader family(rest);
    if (rest.size() >= sizeof mark) family.get(mark);
    if (mark != family_mark) return {std::move(unpacked.row), {rest.begin(), rest.end()}};
    unpacked.row.family = restore_members(family);
  } catch (const std::out_of_range&) {
    throw Error("cannot read the droplets of a row; they are damaged");
  }
  return {std::move(unpacked.row), {}};
}

}  // namespace clog::sweep

#include "clog/sweep/messages.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "clog/core/tools/error.hpp"

namespace clog::sweep {

std::vector<std::byte> to_bytes(const Report& report) {
  std::vector<std::byte> rest = report.snapshot;
  if (!report.row.family.empty()) {
    ByteWriter family;
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
  if (rest.empty() || !is_final(unpacked.row)) return {std::move(unpacked.row), {rest.begin(), rest.end()}};
  try {
    ByteReader family(rest);
    unpacked.row.family = restore_members(family);
  } catch (const std::out_of_range&) {
    throw Error("cannot read the droplets of a row; they are damaged");
  }
  return {std::move(unpacked.row), {}};
}

}  // namespace clog::sweep

#include "clog/sweep/messages.hpp"

#include <algorithm>
#include <utility>

#include "clog/core/tools/error.hpp"

namespace clog::sweep {

std::vector<std::byte> to_bytes(const Report& report) {
  std::vector<std::byte> bytes(packed_size() + report.snapshot.size());
  pack(report.row, std::span(bytes).first(packed_size()));
  std::ranges::copy(report.snapshot, bytes.begin() + static_cast<std::ptrdiff_t>(packed_size()));
  return bytes;
}

Report report_from(std::span<const std::byte> bytes) {
  UnpackedRow unpacked = unpack(bytes.first(packed_size()));
  if (!unpacked.fault.empty())
    throw Error("cannot read a row (" + unpacked.fault + "); it is of another version, or damaged");
  const std::span snapshot = bytes.subspan(packed_size());
  return {std::move(unpacked.row), {snapshot.begin(), snapshot.end()}};
}

}  // namespace clog::sweep

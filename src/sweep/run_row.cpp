#include "clog/sweep/run_row.hpp"

#include <cassert>
#include <cstring>

#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/instruction_set.hpp"
#include "clog/core/tools/number_text.hpp"
#include "clog/sweep/columns.hpp"
#include "clog/sweep/keys.hpp"

namespace clog::sweep {

std::string identity(const RunRow& row) {
  std::string bytes;
  for (const Column& column : columns()) {
    if (column.role != ColumnRole::parameter) continue;
    bytes.resize(bytes.size() + column.size);
    char* const place = bytes.data() + bytes.size() - column.size;
    column.pack(row, reinterpret_cast<std::byte*>(place));
    if (column.kind != ValueKind::number) continue;
    double number = 0;
    std::memcpy(&number, place, sizeof number);
    number = twelve_digits(number);
    std::memcpy(place, &number, sizeof number);
  }
  return bytes;
}

std::string identity_in_any_laboratory(RunRow row) {
  row.parameters.laboratory.reset();
  return identity(row);
}

std::string identity_in_any_version(RunRow row) {
  row.model_version = 0;
  return identity(row);
}

RunRow describe(const RunParameters& run) {
  RunRow row;
  row.parameters = run;
  row.obstacle_density = scene_of(run).density(run.obstacles);
  row.preset = run.model == Model::dp ? preset_name(run) : "none";
  row.instruction_set = run.model == Model::dp ? instruction_set() : "none";
  row.model_version = model_version;
  return row;
}

RunRow begun_row(const RunParameters& run, std::int64_t task) {
  RunRow row = describe(run);
  row.task = task;
  record(RunResult{}, row);
  return row;
}

std::optional<double> observed_distance(const RunRow& row) {
  if (row.status != RunStatus::failed) return row.distance;
  if (is_known(row.sound_distance)) return row.sound_distance;
  // In rows of model version 11, only the message gives the cause.
  const bool has_crossed = row.message.starts_with("the interface crossed itself");
  return has_crossed && is_known(row.distance) ? std::optional(row.distance) : std::nullopt;
}

std::size_t packed_size() {
  static const std::size_t size = [] {
    std::size_t sum = 0;
    for (const Column& column : columns()) sum += column.size;
    return sum;
  }();
  return size;
}

void pack(const RunRow& row, std::span<std::byte> packed) {
  assert(packed.size() == packed_size());
  std::byte* place = packed.data();
  for (const Column& column : columns()) {
    column.pack(row, place);
    place += column.size;
  }
}

UnpackedRow unpack(std::span<const std::byte> packed) {
  assert(packed.size() == packed_size());
  UnpackedRow unpacked;
  const std::byte* place = packed.data();
  for (const Column& column : columns()) {
    column.unpack(place, unpacked);
    place += column.size;
  }
  return unpacked;
}

}  // namespace clog::sweep

#include "clog/results/repetition.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/sweep/columns.hpp"
#include "clog/sweep/obstacle_arrays.hpp"
#include "clog/sweep/run_job.hpp"

namespace clog::results {

using sweep::RunRow;

bool are_equal(const Member& a, const Member& b) {
  const auto bits = [](const Member& one) {
    return std::bit_cast<std::array<std::uint64_t, 7>>(
        std::array{one.diameter, one.birth.distance, one.birth.lateral, one.birth.time, one.end.distance,
                   one.end.lateral, one.end.time});
  };
  return a.path == b.path && a.status == b.status && a.mechanism == b.mechanism && bits(a) == bits(b);
}

std::vector<std::string> differing_results(const RunRow& a, const RunRow& b) {
  const auto packed = [](const sweep::Column& column, const RunRow& row) {
    std::vector<std::byte> bytes(column.size);
    column.pack(row, bytes.data());
    return bytes;
  };
  std::vector<std::string> all;
  for (const sweep::Column& column : sweep::columns())
    if (column.role == sweep::ColumnRole::result && packed(column, a) != packed(column, b))
      all.push_back(column.name);
  if (!std::ranges::equal(a.family, b.family, are_equal)) all.emplace_back("droplets");
  return all;
}

Repetition repeat(const RunRow& row) {
  sweep::RunJob job(row.parameters, row.task);
  while (!job.advance()) continue;
  const RunRow again = job.row();
  return {again, differing_results(row, again)};
}

const Member& member_of(const RunRow& row, const std::string& path) {
  const auto found = std::ranges::find(row.family, path, &Member::path);
  if (found != row.family.end()) return *found;
  std::vector<std::string> paths;
  for (const Member& member : row.family)
    if (!member.path.empty()) paths.push_back(member.path);
  throw Error(fmt::format("unknown --droplet={} ({}); {}", path,
                          paths.empty()
                              ? fmt::format("task {} has no daughters", row.task)
                              : fmt::format("the daughters of task {} are {}", row.task, joined(paths)),
                          paths.empty() ? "leave it out" : "give one of them"));
}

FamilyRun family_of(const RunRow& row) {
  return {row.parameters, sweep::ObstacleArrays().get(row.parameters)};
}

}  // namespace clog::results

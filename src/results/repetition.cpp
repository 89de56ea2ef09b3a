#include "clog/results/repetition.hpp"

#include <cstddef>

#include "clog/sweep/columns.hpp"
#include "clog/sweep/run_job.hpp"

namespace clog::results {

using sweep::RunRow;

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
  return all;
}

Repetition repeat(const RunRow& row) {
  sweep::RunJob job(row.parameters, row.task);
  while (!job.advance()) continue;
  const RunRow again = job.row();
  return {again, differing_results(row, again)};
}

}  // namespace clog::results

#include "clog/campaign/repetition.hpp"

#include <cmath>
#include <cstddef>

#include "clog/sweep/columns.hpp"
#include "clog/sweep/run_job.hpp"

namespace clog::campaign {

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

bool complete_results(RunRow& row, const RunRow& from) {
  const bool has_dwells = !std::isnan(row.dwells.known_from) || std::isnan(from.dwells.known_from);
  const bool has_contacts = row.contacts >= 0 || from.contacts < 0;
  if (!has_dwells) row.dwells = from.dwells;
  if (!has_contacts) {
    row.contacts = from.contacts;
    row.first_contact_at = from.first_contact_at;
  }
  return !has_dwells || !has_contacts;
}

Repetition repeat(const RunRow& row) {
  sweep::RunJob job(row.parameters, row.task);
  while (!job.advance()) continue;
  const RunRow again = job.row();
  RunRow before = row;
  complete_results(before, again);
  return {again, differing_results(before, again)};
}

}  // namespace clog::campaign

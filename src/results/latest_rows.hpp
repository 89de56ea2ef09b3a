#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include "clog/store/journal.hpp"

namespace clog::results {

/// A run that latest_rows() found in the table or the journal of a sweep: its row and its record.
struct LatestRow {
  sweep::RunRow* in_table = nullptr;        ///< nullptr: only the journal has the run
  store::Journal::Entry* record = nullptr;  ///< the record that replaces the table's row; nullptr: none

  sweep::RunRow& row() const { return record ? record->row : *in_table; }
  bool was_final() const { return in_table && sweep::is_final(*in_table); }
};

/// Joins the rows of a table with the records of its journal, oldest first. A record replaces the earlier row
/// of its run, unless that row is final and the record is not. In this case, the journal has lost the run's
/// last record. The result has the rows in the order of the table, followed by the runs that only the journal
/// has. If the table has several rows of a run, records replace the first of these.
/// @param key  function of a row that identifies the run
template <class Key = std::string (*)(const sweep::RunRow&)>
std::vector<LatestRow> latest_rows(std::span<sweep::RunRow> rows, std::span<store::Journal::Entry> records,
                                   Key key = sweep::identity) {
  std::vector<LatestRow> runs;
  runs.reserve(rows.size());
  std::unordered_map<std::invoke_result_t<Key, const sweep::RunRow&>, std::size_t> places;
  for (sweep::RunRow& row : rows) {
    if (!records.empty()) places.emplace(key(row), runs.size());
    runs.push_back({&row});
  }
  for (store::Journal::Entry& record : records) {
    const auto [place, is_new] = places.emplace(key(record.row), runs.size());
    if (is_new)
      runs.push_back({nullptr, &record});
    else if (LatestRow& run = runs[place->second]; sweep::is_final(record.row) || !sweep::is_final(run.row()))
      run.record = &record;
  }
  return runs;
}

/// Corrects the status of a row in a file to which no sweep is writing: its run cannot be running.
inline void interrupt_if_running(sweep::RunRow& row) {
  if (row.status == RunStatus::running) row.status = RunStatus::interrupted;
}

}  // namespace clog::results

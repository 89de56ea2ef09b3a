#pragma once

#include <span>
#include <vector>

#include "clog/store/journal.hpp"

namespace clog::results {

/// A run of a sweep in its table and its journal: points to the row and the record that latest_rows() found.
struct LatestRow {
  sweep::RunRow* in_table = nullptr;        ///< nullptr: only the journal has the run
  store::Journal::Entry* record = nullptr;  ///< the record that replaces the table's row; nullptr: none

  sweep::RunRow& row() const { return record ? record->row : *in_table; }
  bool was_final() const { return in_table && sweep::is_final(*in_table); }
};

/// The column by which runs are recognised. Task numbers need less memory, but identify a run only while the
/// plan is unchanged.
enum class RunKey { identity, task };

/// Joins the rows of a table with the records of its journal, oldest first. A record replaces the known row
/// of its run, unless that row is final and the record is not: then the journal has lost the run's last
/// record. The result has the rows in their order, followed by the runs that only the journal has. If the
/// table repeats a run, records replace its first row.
std::vector<LatestRow> latest_rows(std::span<sweep::RunRow> rows, std::span<store::Journal::Entry> records,
                                   RunKey key = RunKey::identity);

/// No run is running in a file to which no sweep writes.
inline void interrupt_if_running(sweep::RunRow& row) {
  if (row.status == RunStatus::running) row.status = RunStatus::interrupted;
}

}  // namespace clog::results

#pragma once

#include <string>
#include <vector>

#include "clog/store/journal.hpp"
#include "clog/store/run_table.hpp"

namespace clog::results {

/// The undamaged rows of a damaged sweep file and of the journal beside it.
struct Salvage {
  store::SweepFile table;                        ///< the table, including results that only the journal had
  std::vector<store::Journal::Entry> snapshots;  ///< snapshots of unfinished runs
  std::int64_t num_from_journal = 0;             ///< rows of `table` with a result from the journal
  std::vector<std::string> damage;               ///< a sentence about each damaged part
};

/// Reads everything that is undamaged. Changes no file. @throws Error if the table is missing, not written by
/// clogsweep, or completely unreadable
Salvage salvage(const std::string& path);
/// Removes rows that are physically impossible, or that repeat the run of an earlier row. Returns a line for
/// each removed row.
std::vector<std::string> drop_faulty(std::vector<sweep::RunRow>& rows);
/// Removes intact rows and attributes that would make verify() refuse the file. Adds a line for each of them
/// to the damage.
void drop_what_verify_refuses(const std::string& path, Salvage& found);
/// Writes the table, and a journal beside it if there are snapshots. @throws Error if the table exists
void write(const store::SweepFile& table, const std::vector<store::Journal::Entry>& snapshots,
           const std::string& path);

}  // namespace clog::results

#include "clog/results/salvage.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>

#include "clog/console/streams.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/wording.hpp"
#include "clog/results/growth.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/sweep/row_check.hpp"
#include "latest_rows.hpp"

namespace clog::results {
namespace {

/// The fixed values that identify records of this sweep; nullopt if the sweep's config is lost, or of another
/// version.
std::optional<FixedValues> fixed_values(const std::string& path, const store::SweepFile& table) try {
  return FixedValues(stored_plan(path, table), stored_settings(path, table.provenance));
} catch (const Error& error) {
  say_unread(path, "records of its journal may be of another sweep", error);
  return std::nullopt;
}

/// Undamaged records of this sweep, oldest first.
std::vector<store::Journal::Entry> records_of(const std::string& path, Salvage& found) {
  const std::string journal = store::journal_path(path);
  std::vector<store::Journal::Entry> records;
  try {
    const auto contents = store::Journal::look(journal);
    if (!contents) return {};
    records = contents->entries;
    if (contents->num_unreadable > 0)
      found.damage.push_back(
          fmt::format("damaged in its journal: {}", count_text(contents->num_unreadable, "record")));
  } catch (const Error& error) {
    found.damage.push_back(fmt::format("its journal was not used: {}", error.what()));
    return {};
  }
  if (records.empty()) return {};
  const std::optional<FixedValues> fixed = fixed_values(path, found.table);
  const std::size_t num_foreign = std::erase_if(records, [&](const store::Journal::Entry& record) {
    return !sweep::fault_of(record.row).empty() || (fixed && !fixed->differing_keys(record.row).empty());
  });
  if (num_foreign > 0)
    found.damage.push_back(fmt::format("of another sweep in its journal: {}",
                                       count_text(static_cast<std::int64_t>(num_foreign), "record")));
  return records;
}

}  // namespace

Salvage salvage(const std::string& path) {
  store::Examination examined = store::examine_sweep(path);
  Salvage found;
  found.table = std::move(examined.whole);
  found.damage = std::move(examined.damage);
  std::vector<store::Journal::Entry> records = records_of(path, found);
  std::vector<sweep::RunRow> rows;
  for (const LatestRow& run : latest_rows(found.table.rows, records)) {
    const bool is_unfinished = sweep::is_unfinished(run.row().status);
    if (run.record && !is_unfinished && !run.was_final()) ++found.num_from_journal;
    // Rows are moved, because there may be memory for only one copy of the rows of a large sweep. Only rows
    // with a snapshot are copied.
    if (run.record && is_unfinished && !run.record->snapshot.empty()) {
      rows.push_back(run.row());
      found.snapshots.push_back(std::move(*run.record));
    } else {
      rows.push_back(std::move(run.row()));
    }
    interrupt_if_running(rows.back());
  }
  std::ranges::stable_sort(rows, {}, &sweep::RunRow::task);
  std::ranges::stable_sort(found.snapshots, {},
                           [](const store::Journal::Entry& one) { return one.row.task; });
  found.table.rows = std::move(rows);
  return found;
}

std::vector<std::string> drop_faulty(std::vector<sweep::RunRow>& rows) {
  std::vector<std::string> faults;
  std::unordered_map<std::string, std::int64_t> seen;  // tasks by the identity of their runs
  std::erase_if(rows, [&](const sweep::RunRow& row) {
    std::string fault = sweep::fault_of(row);
    if (fault.empty())
      if (const auto [first, is_new] = seen.emplace(sweep::identity(row), row.task); !is_new)
        fault = fmt::format("the same run as task {}", first->second);
    if (!fault.empty()) faults.push_back(fmt::format("task {}: {}", row.task, fault));
    return !fault.empty();
  });
  return faults;
}

void drop_what_verify_refuses(const std::string& path, Salvage& found) {
  for (std::string& fault : drop_faulty(found.table.rows)) found.damage.push_back(std::move(fault));
  store::Provenance& provenance = found.table.provenance;
  if (attribute(provenance, "config").empty()) return;
  try {
    stored_num_runs(path, found.table, stored_plan(path, found.table));
  } catch (const Error& error) {
    std::erase_if(provenance,
                  [](const auto& one) { return one.first == "config" || one.first == "num_wanted"; });
    found.damage.emplace_back(error.what());
  }
}

void write(const store::SweepFile& table, const std::vector<store::Journal::Entry>& snapshots,
           const std::string& path) {
  store::refuse_existing(path);
  const store::OutputPath place = store::OutputPath::resolve(path);
  if (!store::publish_sweep(place, "", table)) store::refuse_to_overwrite(path);
  if (const std::string& fault = place.sync_fault(); !fault.empty())
    console::say(
        fmt::format("{} is complete, but its folder cannot be synced ({}): a power cut may lose it; copy it "
                    "elsewhere, too",
                    path, fault));
  if (snapshots.empty()) return;
  store::Journal journal(store::journal_place(place), &place);
  for (const auto& [row, snapshot] : snapshots) journal.add(row, snapshot);
  journal.flush();
}

}  // namespace clog::results

#include "resumption.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "clog/results/growth.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/sweep/row_check.hpp"
#include "latest_rows.hpp"

namespace clog::results {
namespace {

using Entry = SweepRuns::Entry;
/// Runs by their identity.
using Known = std::unordered_map<std::string, std::unique_ptr<Entry>>;

/// Names the settings in which the file differs from the sweep. If a salvaged file has lost its config,
/// compares the rows with the settings.
std::string settings_that_differ(const Resumption& sweep, const store::SweepFile& table) {
  if (!attribute(table.provenance, "config").empty())
    return differing_keys(stored_settings(sweep.path, table.provenance), sweep.settings);
  if (table.rows.empty()) return "";
  const FixedValues fixed(sweep.plan, sweep.settings);
  for (const sweep::RunRow& row : table.rows)
    if (std::string differing = fixed.differing_keys(row); !differing.empty()) return differing;
  return "";
}

void refuse_other_sweep(const Resumption& sweep, const store::SweepFile& table) {
  const std::string remedy = "; give another --output";
  for (const sweep::RunRow& row : table.rows)
    if (row.model_version != model_version)
      throw Error(
          fmt::format("cannot resume {} (its runs are of model version {}, this program's is {}: the "
                      "same parameters would give other results){}",
                      sweep.path, row.model_version, model_version, remedy));
  const std::string differing = settings_that_differ(sweep, table);
  if (!differing.empty())
    throw Error(fmt::format("cannot resume {} (it holds runs with other settings: {}){}", sweep.path,
                            differing, remedy));
}

/// Refuses runs of another sweep. The journal contains such runs if another sweep had the same path.
void refuse_foreign_records(const Resumption& sweep, const std::vector<LatestRow>& runs) {
  const auto is_new = [](const LatestRow& run) { return !run.in_table; };
  if (std::ranges::none_of(runs, is_new)) return;
  const FixedValues fixed(sweep.plan, sweep.settings);
  for (const LatestRow& run : runs)
    if (const std::string differing = is_new(run) ? fixed.differing_keys(run.row()) : ""; !differing.empty())
      throw Error(
          fmt::format("cannot resume {} (its journal {} is of another sweep: {}); move the journal to "
                      "the table that it belongs to, or give another --output",
                      sweep.path, store::journal_path(sweep.path), differing));
}

/// Whether the task with the row's number in the plan is the row's run. If the sweep resumes unchanged, this
/// is true for all rows.
bool is_of_its_task(const sweep::RunRow& row, const sweep::Plan& plan) {
  return row.task >= 0 && row.task < plan.size() &&
         sweep::identity(row) == sweep::identity(sweep::describe(plan.task(row.task)));
}

/// Assigns the runs to their tasks. A task without a run gets the equal run of another laboratory, because
/// runs do not depend on the laboratory. If no task of that laboratory needs the row, the row's laboratory is
/// changed; otherwise the row is copied.
void find_runs(Known& known, std::int64_t num_tasks, const sweep::Plan& plan, SweepRuns& runs) {
  std::unordered_map<std::string, std::string> others;  // by identity without a laboratory
  std::vector<std::int64_t> without;
  std::unordered_map<std::string, const Entry*> in_plan;
  const auto task_row = [&](std::int64_t task) { return sweep::describe(plan.task(task)); };
  for (std::int64_t task = 0; task < num_tasks; ++task) {
    const sweep::RunRow row = task_row(task);
    if (auto found = known.extract(sweep::identity(row)); !found.empty())
      runs.place_of(task) = std::move(found.mapped());
    const Entry* const run = runs.find(task);
    if (row.parameters.laboratory && !run) without.push_back(task);
    if (row.parameters.laboratory && run && runs.is_over(run->row))
      in_plan.emplace(sweep::identity_in_any_laboratory(row), run);
  }
  if (without.empty()) return;
  for (const auto& [run, entry] : known) others.emplace(sweep::identity_in_any_laboratory(entry->row), run);
  for (const std::int64_t task : without) {
    const sweep::RunRow row = task_row(task);
    const std::string run = sweep::identity_in_any_laboratory(row);
    std::unique_ptr<Entry> found;
    if (const auto other = others.find(run); other != others.end() && known.contains(other->second))
      found = std::move(known.extract(other->second).mapped());
    else if (const auto shared = in_plan.find(run); shared != in_plan.end())
      found = copy_without_costs(*shared->second);
    else
      continue;
    found->row.parameters.laboratory = row.parameters.laboratory;
    in_plan.try_emplace(run, found.get());
    runs.place_of(task) = std::move(found);
  }
}

/// The number of tasks at the start of the plan that may have begun.
std::int64_t num_tasks_known(const Resumption& sweep, const Known& known, const SweepRuns& runs) {
  std::int64_t last_seed = -1;
  for (const auto& [run, entry] : known)
    last_seed = std::max(last_seed, std::int64_t{entry->row.parameters.seed});
  std::int64_t number = std::min(sweep.plan.size(), std::max(sweep.num_wanted, std::ssize(runs.by_task)));
  // Further seeds are added in increasing order, so no seed after this one has begun.
  while (!known.empty() && number < sweep.plan.size() && sweep.plan.task(number).seed <= last_seed) ++number;
  return number;
}

}  // namespace

std::int64_t adopt(const Resumption& sweep, store::SweepFile table, std::vector<Entry> records,
                   SweepRuns& runs) {
  refuse_other_sweep(sweep, table);
  const auto is_usual = [&](const sweep::RunRow& row) { return is_of_its_task(row, sweep.plan); };
  const bool are_usual =
      std::ranges::all_of(table.rows, is_usual) && std::ranges::all_of(records, is_usual, &Entry::row);
  const std::vector<LatestRow> latest =
      are_usual ? latest_rows(table.rows, records, [](const sweep::RunRow& row) { return row.task; })
                : latest_rows(table.rows, records);
  refuse_foreign_records(sweep, latest);
  Known known;
  std::int64_t num_faulty = 0;
  for (const LatestRow& one : latest) {
    sweep::RunRow& row = one.row();
    interrupt_if_running(row);
    if (!sweep::fault_of(row).empty()) {
      ++num_faulty;
      continue;
    }
    std::unique_ptr<Entry>& run = are_usual ? runs.place_of(row.task) : known[sweep::identity(row)];
    // Rows are moved, not copied, because there may be memory for only one copy of the rows of a large sweep.
    if (!run) run = std::make_unique<Entry>(one.record ? std::move(*one.record) : Entry{std::move(row), {}});
  }
  const std::int64_t num_tasks = num_tasks_known(sweep, known, runs);
  if (!known.empty() || (num_tasks > 0 && sweep.plan.task(0).laboratory))
    find_runs(known, num_tasks, sweep.plan, runs);
  for (std::int64_t task = 0; task < std::ssize(runs.by_task); ++task)
    if (Entry* const run = runs.find(task)) run->row.task = task;
  for (auto& [run, entry] : known) runs.others.push_back(std::move(entry));
  std::ranges::sort(runs.others, {}, [](const auto& run) { return run->row.task; });
  for (std::int64_t task = sweep.plan.size(); const auto& run : runs.others) run->row.task = task++;
  return num_faulty;
}

}  // namespace clog::results

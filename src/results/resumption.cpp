#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/results/sweep_state.hpp"
#include "clog/sweep/row_check.hpp"
#include "clog/sweep/run_row.hpp"

/// What a sweep adopts from the table and the journal of its earlier sessions.
namespace clog::results {

/// Whether the row belongs to the run that has its task number in the plan. Usually all rows do, because the
/// sweep resumes unchanged.
bool SweepState::is_of_its_task(const sweep::RunRow& row) const {
  return row.task >= 0 && row.task < plan_->size() &&
         sweep::identity(row) == sweep::identity(sweep::describe(plan_->task(row.task)));
}

/// Turns rows of the table, and then records of the journal in its order, into runs. The runs go to runs_ if
/// every row belongs to its task, otherwise to the list that the function returns. Rows are moved, because a
/// large sweep has memory for each row just once.
SweepState::Known SweepState::recognise(std::vector<sweep::RunRow> rows, std::vector<Entry> records,
                                        const sweep::Settings& settings) {
  Known known;
  const bool is_usual =
      std::ranges::all_of(rows, [&](const auto& row) { return is_of_its_task(row); }) &&
      std::ranges::all_of(records, [&](const auto& record) { return is_of_its_task(record.row); });
  const auto place = [&](const sweep::RunRow& row) -> std::unique_ptr<Entry>& {
    return is_usual ? place_of(row.task) : known[sweep::identity(row)];
  };
  for (sweep::RunRow& row : rows) {
    std::unique_ptr<Entry>& run = place(row);
    run = std::make_unique<Entry>(Entry{std::move(row), {}});
  }
  std::optional<FixedValues> fixed;
  for (Entry& record : records) {
    std::unique_ptr<Entry>& run = place(record.row);
    if (!run && !fixed) fixed.emplace(*plan_, settings);
    if (!run) refuse_foreign(record.row, *fixed);
    // If the journal has lost a run's last record, the table has the result, and the journal only an earlier
    // state. Then the table's row is kept.
    if (!run || sweep::is_final(record.row) || !sweep::is_final(run->row))
      run = std::make_unique<Entry>(std::move(record));
  }
  const auto is_faulty = [](const std::unique_ptr<Entry>& run) {
    return run && !sweep::fault_of(run->row).empty();
  };
  num_faulty_ =
      std::ranges::count_if(runs_, is_faulty) +
      static_cast<std::int64_t>(std::erase_if(known, [&](const auto& one) { return is_faulty(one.second); }));
  std::ranges::replace_if(runs_, is_faulty, nullptr);
  return known;
}

/// Reads the table, and checks that its path, which readers use, leads to the same file as the open folder,
/// which the sweep uses.
store::SweepFile SweepState::read_table() {
  stamp_ = place_.stamp();
  store::SweepFile file = store::read_sweep(path_);
  if (place_.stamp() != stamp_ || store::OutputPath::resolve(path_).stamp() != stamp_)
    throw Error("cannot resume " + path_ +
                " (it was replaced or moved while it was read); try again when it stays in place");
  store::refuse_foreign_objects(path_, file);
  return file;
}

/// A salvaged file may lack its config. In this case, this function compares the rows with the settings.
std::string SweepState::settings_that_differ(const store::SweepFile& file,
                                             const sweep::Settings& settings) const {
  if (!attribute(file.provenance, "config").empty())
    return differing_keys(stored_settings(path_, file.provenance), settings);
  const FixedValues fixed(*plan_, settings);
  for (const sweep::RunRow& row : file.rows)
    if (std::string differing = fixed.differing_keys(row); !differing.empty()) return differing;
  return "";
}

/// Adopts an existing file if its runs belong to this sweep, and keeps the file's provenance.
void SweepState::adopt(const store::SweepFile& file, const sweep::Settings& settings) {
  const std::string remedy = "; give another --output";
  for (const sweep::RunRow& row : file.rows)
    if (row.model_version != model_version)
      throw Error(
          fmt::format("cannot resume {} (its runs are of model version {}, this program's is {}: the "
                      "same parameters would give other results){}",
                      path_, row.model_version, model_version, remedy));
  const std::string differing = settings_that_differ(file, settings);
  if (!differing.empty())
    throw Error(
        fmt::format("cannot resume {} (it holds runs with other settings: {}){}", path_, differing, remedy));
  store::Provenance all = file.provenance;
  for (const char* name : {"config", "stopping_rule", "num_wanted"})
    set_attribute(all, name, attribute(provenance_, name));
  provenance_ = std::move(all);
}

/// Refuses a record of another sweep, which may have left its journal here.
void SweepState::refuse_foreign(const sweep::RunRow& record, const FixedValues& fixed) const {
  const std::string differing = fixed.differing_keys(record);
  if (!differing.empty())
    throw Error(
        fmt::format("cannot resume {} (its journal {} is of another sweep: {}); move the journal to "
                    "the table that it belongs to, or give another --output",
                    path_, journal_.path(), differing));
}

/// Keeps circles of runs outside this plan.
void SweepState::keep_circles(const store::SweepFile& file) {
  for (const store::CircleFile& one : file.circles)
    if (std::ranges::none_of(circles_, [&](const auto& known) { return known.circles == one.circles; }))
      circles_.push_back({"", one.circles});
}

/// Gives tasks their runs, and those that have none the run of another laboratory, on which runs do not
/// depend. A row that no task of its own laboratory needs changes its laboratory; others are copied.
void SweepState::find_runs(Known& known, std::int64_t num_tasks) {
  std::unordered_map<std::string, std::string> others;  // identities of runs by those in any laboratory
  std::vector<std::int64_t> without;
  std::unordered_map<std::string, const Entry*> in_plan;
  const auto task_row = [&](std::int64_t task) { return sweep::describe(plan_->task(task)); };
  for (std::int64_t task = 0; task < num_tasks; ++task) {
    const sweep::RunRow row = task_row(task);
    if (auto found = known.extract(sweep::identity(row)); !found.empty())
      place_of(task) = std::move(found.mapped());
    const Entry* const run = entry(task);
    if (row.parameters.laboratory && !run) without.push_back(task);
    if (row.parameters.laboratory && run && is_over(run->row))
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
      found = copy_of(*shared->second);
    else
      continue;
    found->row.parameters.laboratory = row.parameters.laboratory;
    in_plan.try_emplace(run, found.get());
    place_of(task) = std::move(found);
  }
}

/// The number of tasks, from the start of the plan, that may have begun.
std::int64_t SweepState::num_tasks_known(const Known& known) const {
  std::int64_t last_seed = -1;
  for (const auto& [run, entry] : known)
    last_seed = std::max(last_seed, std::int64_t{entry->row.parameters.seed});
  std::int64_t number = std::min(plan_->size(), std::max(num_wanted_, std::ssize(runs_)));
  // Seeds that may be added later follow in increasing order: no later seed has begun yet.
  while (!known.empty() && number < plan_->size() && plan_->task(number).seed <= last_seed) ++number;
  return number;
}

void SweepState::find_tasks(Known known) {
  const std::int64_t num_tasks = num_tasks_known(known);
  if (!known.empty() || (num_tasks > 0 && plan_->task(0).laboratory)) find_runs(known, num_tasks);
  for (std::int64_t task = 0; task < num_tasks; ++task) {
    if (Entry* const run = entry(task)) {
      run->row.task = task;
      if (is_over(run->row)) continue;
      if (run->row.status == RunStatus::running) run->row.status = RunStatus::interrupted;
      past_[task].take_costs(run->row);
    }
    if (task < num_wanted_) request(task);
  }
  for (auto& [run, entry] : known) other_runs_.push_back(std::move(entry));
  std::ranges::sort(other_runs_, {}, [](const auto& run) { return run->row.task; });
  for (std::size_t i = 0; i < other_runs_.size(); ++i) {
    sweep::RunRow& row = other_runs_[i]->row;
    row.task = plan_->size() + static_cast<std::int64_t>(i);
    if (row.status == RunStatus::running) row.status = RunStatus::interrupted;
  }
}

}  // namespace clog::results

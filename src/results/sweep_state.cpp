#include "clog/results/sweep_state.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "resumption.hpp"

namespace clog::results {

SweepState::SweepState(std::string path, const sweep::Plan& plan, const sweep::Settings& settings,
                       store::Provenance provenance, std::int64_t num_wanted, std::int64_t attempts)
    : plan_(&plan),
      runs_{.attempts = attempts},
      num_wanted_(num_wanted),
      files_(std::move(path), plan, std::move(provenance), runs_) {
  auto [table, records] = files_.take_earlier();
  num_faulty_ =
      adopt({files_.path(), plan, settings, num_wanted}, std::move(table), std::move(records), runs_);
  for (const std::int64_t task : tasks_begun()) past_[task].take_costs(row(task));
  for (std::int64_t task = 0; task < std::min(num_wanted, plan.size()); ++task) request(task);
  files_.begin_session();
}

void SweepState::want(const std::vector<std::int64_t>& tasks) {
  num_wanted_ += std::ssize(tasks);
  files_.set("num_wanted", std::to_string(num_wanted_));
  tasks_left_.clear();
  waiting_.clear();
  for (const std::int64_t task : tasks) request(task);
}

/// Requests a task that is not over. A task with a twin is not computed, but waits for its twin. Tasks must
/// be requested in increasing order.
void SweepState::request(std::int64_t task) {
  if (const Entry* const run = runs_.find(task); run && runs_.is_over(run->row)) return;
  const std::optional<std::int64_t> twin = plan_->twin(task);
  const Entry* const run = twin ? runs_.find(*twin) : nullptr;
  if (run && runs_.is_over(run->row))
    files_.write_down(copy_to(task, *run));
  else if (twin && std::ranges::binary_search(tasks_left_, *twin))
    waiting_[*twin].push_back(task);
  else
    tasks_left_.push_back(task);
}

/// Copies the row of a twin to its task.
SweepState::Entry& SweepState::copy_to(std::int64_t task, const Entry& twin) {
  std::unique_ptr<Entry> copy = copy_without_costs(twin);
  copy->row.parameters.laboratory = plan_->task(task).laboratory;
  copy->row.task = task;
  std::unique_ptr<Entry>& run = runs_.place_of(task);
  const std::lock_guard lock(runs_.changing);
  if (!run) run = std::make_unique<Entry>();
  *run = std::move(*copy);
  return *run;
}

void SweepState::pass_on(const Entry& twin) {
  if (const auto waiting = waiting_.find(twin.row.task); waiting != waiting_.end())
    for (const std::int64_t task : waiting->second) files_.write_down(copy_to(task, twin));
}

std::int64_t SweepState::num_waiting() const {
  std::int64_t number = 0;
  for (const auto& [twin, tasks] : waiting_) number += std::ssize(tasks);
  return number;
}

std::vector<std::int64_t> SweepState::tasks_begun() const {
  std::vector<std::int64_t> tasks;
  for (const auto& run : runs_.by_task)
    if (run && !runs_.is_over(run->row)) tasks.push_back(run->row.task);
  return tasks;
}

std::int64_t SweepState::num_resumed() const {
  return std::count_if(tasks_left_.begin(), tasks_left_.end(), [this](std::int64_t task) {
    const Entry* const run = runs_.find(task);
    return run && !run->snapshot.empty();
  });
}

sweep::RunRow SweepState::new_row(std::int64_t task) const {
  return sweep::begun_row(plan_->task(task), task);
}

sweep::Start SweepState::start(std::int64_t task, int rank) {
  files_.rank_is_busy();
  std::unique_ptr<Entry>& run = runs_.place_of(task);
  const bool is_new = !run;
  if (is_new) run = std::make_unique<Entry>();
  std::unique_lock lock(runs_.changing);
  Entry& entry = *run;
  sweep::Start start{entry.snapshot, entry.row.attempt};
  const bool failed = !is_new && entry.row.status == RunStatus::failed;
  if (failed) start = {{}, entry.row.attempt + 1};
  if (const auto past = past_.find(task); past != past_.end())
    past->second.instruction_set = start.snapshot.empty() ? "" : entry.row.instruction_set;
  if (is_new || failed) {
    entry.snapshot.clear();
    entry.row = new_row(task);
  }
  entry.row.attempt = start.attempt;
  entry.row.status = RunStatus::running;
  entry.row.rank = rank;
  lock.unlock();
  pass_on(entry);
  return start;
}

void SweepState::restarted(std::int64_t task) {
  files_.restarted();
  past_[task].instruction_set.clear();
}

void SweepState::report(const sweep::Report& report) {
  Entry* const run = runs_.find(report.row.task);
  if (!run || sweep::identity(report.row) != sweep::identity(run->row))
    throw Error(fmt::format(
        "cannot continue with {} (rank {} returned a run with other parameters than those of task {}); "
        "earlier results are in the file; please report this",
        files_.path(), report.row.rank, report.row.task));
  std::unique_lock lock(runs_.changing);
  Entry& entry = *run;
  entry = report;
  if (const auto past = past_.find(report.row.task); past != past_.end()) {
    entry.row.wall_seconds += past->second.wall_seconds;
    entry.row.processor_seconds += past->second.processor_seconds;
    const std::string& before = past->second.instruction_set;
    if (!before.empty() && before != entry.row.instruction_set)
      entry.row.instruction_set = sweep::mixed_instruction_sets;
  }
  if (entry.row.status == RunStatus::failed) past_[entry.row.task].take_costs(entry.row);
  lock.unlock();
  files_.write_down(entry);
  pass_on(entry);
}

const sweep::RunRow* SweepState::first_if_all_failed() const {
  const sweep::RunRow* first = nullptr;
  for (const auto& run : runs_.by_task) {
    if (run && run->row.status != RunStatus::failed) return nullptr;
    if (run && !first) first = &run->row;
  }
  return first;
}

void SweepState::withdraw_failure(std::int64_t task) {
  Entry& entry = *runs_.by_task.at(task);
  {
    const std::lock_guard lock(runs_.changing);
    reset_to_release(entry.row);  // the broken rank's result does not count as progress
  }
  files_.write_down(entry);
  pass_on(entry);
}

std::string SweepState::finish() {
  const std::vector<const Entry*> all = runs_.all();
  const bool is_complete =
      std::ssize(all) - std::ssize(runs_.others) >= num_wanted_ &&
      std::ranges::all_of(all, [this](const Entry* run) { return runs_.is_over(run->row); });
  if (is_complete) return files_.complete();
  files_.stop();
  return "";
}

}  // namespace clog::results

#include "clog/results/sweep_runs.hpp"

#include <cstddef>

namespace clog::results {

SweepRuns::Entry* SweepRuns::find(std::int64_t task) const {
  return task < std::ssize(by_task) ? by_task[static_cast<std::size_t>(task)].get() : nullptr;
}

std::unique_ptr<SweepRuns::Entry>& SweepRuns::place_of(std::int64_t task) {
  const auto place = static_cast<std::size_t>(task);
  if (place >= by_task.size()) by_task.resize(place + 1);
  return by_task[place];
}

std::vector<const SweepRuns::Entry*> SweepRuns::all() const {
  std::vector<const Entry*> runs;
  runs.reserve(by_task.size() + others.size());
  for (const Entries* entries : {&by_task, &others})
    for (const auto& run : *entries)
      if (run) runs.push_back(run.get());
  return runs;
}

bool SweepRuns::tries_again(const sweep::RunRow& failed) const {
  return sweep::may_succeed_later(failed) && failed.attempt < attempts;
}

bool SweepRuns::is_over(const sweep::RunRow& row) const {
  return !sweep::is_unfinished(row.status) && !tries_again(row);
}

sweep::RunRow SweepRuns::published(const sweep::RunRow& row) const {
  if (!tries_again(row)) return row;
  sweep::RunRow next = row;
  restart(next);
  ++next.attempt;
  return next;
}

void restart(sweep::RunRow& row) {
  RunResult nothing;
  nothing.status = RunStatus::interrupted;
  sweep::record(nothing, row);
}

std::unique_ptr<SweepRuns::Entry> copy_of(const SweepRuns::Entry& twin) {
  auto copy = std::make_unique<SweepRuns::Entry>(twin);
  copy->row.wall_seconds = copy->row.processor_seconds = 0;
  return copy;
}

}  // namespace clog::results

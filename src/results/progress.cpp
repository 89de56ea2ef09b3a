#include "clog/results/progress.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "clog/console/duration.hpp"
#include "clog/results/groups.hpp"

namespace clog::results {
namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

std::int64_t count_in(const std::map<std::string, std::int64_t>& by_outcome, const std::string& outcome) {
  const auto found = by_outcome.find(outcome);
  return found == by_outcome.end() ? 0 : found->second;
}

std::string text_of_clogs(const std::map<std::string, std::int64_t>& by_outcome) {
  const std::int64_t num_clogged = count_in(by_outcome, name(RunStatus::clogged));
  const std::int64_t num_at_rest = count_in(by_outcome, outcome_at_rest);
  if (num_at_rest == 0) return fmt::format("{} clogged", num_clogged);
  return (num_clogged > 0 ? fmt::format("{} clogged, ", num_clogged) : "") +
         fmt::format("{} {}", num_at_rest, outcome_at_rest);
}

Progress::Progress(std::ostream& out, Screen screen, int num_computing_ranks, sweep::GroupOf set_of)
    : status_(out, screen), number_of_set_(std::move(set_of)), num_ranks_(num_computing_ranks) {}

SetTimes& Progress::set_of(std::int64_t task) {
  const auto number = static_cast<std::size_t>(number_of_set_(task));
  if (number >= sets_.size()) sets_.resize(number + 1);
  return sets_[number];
}

void Progress::expect(std::span<const std::int64_t> tasks, std::int64_t num_wanted) {
  for (const std::int64_t task : tasks) ++set_of(task).num_waiting;
  num_tasks_ += static_cast<std::int64_t>(tasks.size());
  num_before_ = num_wanted - num_tasks_;
}

void Progress::started(std::int64_t task) { running_[task] = Clock::now(); }

void Progress::ended(const sweep::RunRow& row) {
  running_.erase(row.task);
  ++ended_by_outcome_[outcome_of(row)];
  if (row.status == RunStatus::interrupted) return;
  ++num_ended_;
  SetTimes& set = set_of(row.task);
  set.count(row);
  --set.num_waiting;
}

void Progress::not_ended(const sweep::RunRow& failed) {
  --ended_by_outcome_[outcome_of(failed)];
  --num_ended_;
  SetTimes& set = set_of(failed.task);
  --set.num_finished;
  ++set.num_waiting;
}

void Progress::tick() {
  if (status_.is_due()) status_.redraw(line());
}

void Progress::finish() {
  status_.redraw(line());
  status_.keep();
}

std::string Progress::line() const {
  const auto count = [this](RunStatus status) { return count_in(ended_by_outcome_, name(status)); };
  std::string text = fmt::format("{}/{} done, ", num_before_ + num_ended_, num_before_ + num_tasks_);
  if (num_before_ > 0) text += fmt::format("{} of them before; now ", num_before_);
  text += fmt::format("{} running, {}, {} flowing", running_.size(), text_of_clogs(ended_by_outcome_),
                      count(RunStatus::flowing));
  for (const RunStatus status :
       {RunStatus::broken, RunStatus::passed, RunStatus::failed, RunStatus::interrupted})
    if (count(status) != 0) text += fmt::format(", {} {}", count(status), name(status));
  const double elapsed = seconds_since(begin_);
  if (num_ended_ > 0)
    text += fmt::format(", {:.3g} runs/min", 60 * static_cast<double>(num_ended_) / elapsed);
  return fmt::format("{}, {} so far{}", text, console::readable_duration(elapsed), time_left());
}

std::string Progress::time_left() const {
  if (num_ended_ == num_tasks_) return "";
  std::vector<SetTimes> sets = sets_;
  for (const auto& [task, begin] : running_) {
    SetTimes& set = sets[static_cast<std::size_t>(number_of_set_(task))];
    ++set.num_running;
    --set.num_waiting;
    set.seconds += seconds_since(begin);
  }
  return ", " + results::time_left(sets, static_cast<std::size_t>(num_ranks_)).text();
}

}  // namespace clog::results

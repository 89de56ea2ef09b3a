#pragma once

#include <chrono>
#include <cstdint>
#include <iosfwd>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "clog/console/status_line.hpp"
#include "clog/results/time_left.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/run_row.hpp"

namespace clog::results {

/// The number of runs with an outcome, see outcome_of().
std::int64_t count_in(const std::map<std::string, std::int64_t>& by_outcome, const std::string& outcome);
/// The number of clogged droplets and the number of droplets at rest on a wall. Numbers of 0 are omitted, but
/// at least one number is given. @param by_outcome  see outcome_of()
std::string text_of_clogs(const std::map<std::string, std::int64_t>& by_outcome);

/// Reports the progress of a sweep on a StatusLine.
class Progress {
 public:
  using Screen = console::StatusLine::Screen;

  /// @param set_of  parameter set of a task
  Progress(std::ostream& out, Screen screen, int num_computing_ranks, sweep::GroupOf set_of);

  /// Adds tasks to the total against which progress is measured.
  /// @param num_wanted  number of runs of the whole sweep; runs that are not in `tasks` were done before
  void expect(std::span<const std::int64_t> tasks, std::int64_t num_wanted);

  void started(std::int64_t task);
  void ended(const sweep::RunRow& row);
  /// An attempt failed; the task will be tried again.
  void tried(std::int64_t task) { running_.erase(task); }
  /// Withdraws the report of a failed task, because the task will run again.
  void not_ended(const sweep::RunRow& failed);
  /// Prints a permanent line, on any screen.
  void say(const std::string& text) { status_.say(text); }
  /// Redraws the line if it is due.
  void tick();
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  console::StatusLine status_;
  sweep::GroupOf number_of_set_;
  std::vector<SetTimes> sets_;  // tasks in running_ count as waiting here
  std::int64_t num_tasks_ = 0;
  std::int64_t num_before_ = 0;
  int num_ranks_;
  Clock::time_point begin_ = Clock::now();
  std::map<std::int64_t, Clock::time_point> running_;
  std::map<std::string, std::int64_t> ended_by_outcome_;
  std::int64_t num_ended_ = 0;  // number of ended tasks of all sets

  SetTimes& set_of(std::int64_t task);
  std::string line() const;
  std::string time_left() const;
};

}  // namespace clog::results

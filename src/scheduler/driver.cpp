#include "clog/scheduler/driver.hpp"

#include <fmt/core.h>

#include <chrono>
#include <cstdint>
#include <iostream>
#include <ratio>
#include <string>
#include <unordered_set>
#include <vector>

#include "clog/console/exit_codes.hpp"
#include "clog/console/signals.hpp"
#include "clog/console/status_line.hpp"
#include "clog/console/streams.hpp"
#include "clog/results/progress.hpp"
#include "clog/scheduler/task_order.hpp"

namespace clog::scheduler {
namespace {

using Clock = std::chrono::steady_clock;
/// Rank 0's message to the other ranks after a round.
enum class AfterRound { over, another };

results::Progress::Screen screen(Log::Level level) {
  if (level == Log::Level::quiet) return results::Progress::Screen::none;
  return console::StatusLine::standard_error();
}

/// Connects the scheduler's callbacks with the state of the sweep, the log and the progress line.
class Driver {
 public:
  Driver(const DriverOptions& options, const sweep::GroupOf& group_of, results::SweepState& state,
         int num_ranks)
      : state_(state),
        progress_(std::cerr, screen(options.log), num_ranks, group_of),
        log_(progress_, options.log),
        max_hours_(options.max_hours) {}

  /// Adds tasks to the total against which progress is measured.
  void expect(const std::vector<std::int64_t>& tasks) {
    is_expecting_ = is_expecting_ || !tasks.empty();
    progress_.expect(tasks, state_.num_wanted() - state_.num_waiting());
  }

  scheduler::SweepEvents events() {
    scheduler::SweepEvents events;
    events.started = [this](std::int64_t task, int rank) { return start(task, rank); };
    events.progressed = [this](sweep::Report report) { store(report); };
    events.ended = [this](const sweep::Report& report) { end(report); };
    events.tries_again = [this](const sweep::RunRow& failed) { return state_.tries_again(failed); };
    events.failure_withdrawn = [this](std::int64_t task, const std::string& machine) {
      withdraw_failure(task, machine);
    };
    events.set_aside = [this](const MachineTrust::Suspect& machine) { log_.set_aside(machine); };
    events.idle = [this] {
      state_.tick();
      progress_.tick();
    };
    events.stop_requested = [this] {
      const char* reason = reason_to_stop();
      if (reason) log_.stopping(reason);
      return reason != nullptr;
    };
    return events;
  }

  void finish() {
    if (const std::string fault = state_.finish(); !fault.empty()) progress_.say("clogsweep: " + fault);
    if (is_expecting_) progress_.finish();
  }
  bool was_interrupted() const { return was_interrupted_; }
  /// The reason why the sweep must stop now; nullptr if it need not stop.
  const char* reason_to_stop() const {
    if (console::stop_signalled()) return "a signal";
    const std::chrono::duration<double, std::ratio<3600>> hours = Clock::now() - begin_;
    return hours.count() >= max_hours_ ? "--max-hours" : nullptr;
  }

 private:
  results::SweepState& state_;
  bool is_expecting_ = false;
  results::Progress progress_;
  Log log_;
  double max_hours_;
  bool was_interrupted_ = false;
  std::unordered_set<std::int64_t> restarted_;  // running tasks that could not use their snapshots
  Clock::time_point begin_ = Clock::now();

  sweep::Start start(std::int64_t task, int rank) {
    progress_.started(task);
    restarted_.erase(task);
    sweep::Start start = state_.start(task, rank);
    log_.started(state_.row(task), start.snapshot.empty() ? Log::From::release : Log::From::snapshot);
    return start;
  }

  /// Stores a report, but without the reason for a restart, which is only printed in the log (see
  /// sweep::Job::row()).
  void store(sweep::Report& report) {
    sweep::RunRow& row = report.row;
    if (row.status != RunStatus::failed && !row.message.empty()) {
      if (restarted_.insert(row.task).second) {
        log_.restarted(row);
        state_.restarted(row.task);
      }
      row.message.clear();
    }
    state_.report(report);
  }

  void end(sweep::Report report) {
    state_.rank_is_free();
    // If a resumed task is stopped before its first report, the stored snapshot and row still describe its
    // state.
    if (report.row.status == RunStatus::interrupted && report.row.steps == 0 && !report.snapshot.empty()) {
      report.row = state_.row(report.row.task);
      report.row.status = RunStatus::interrupted;
      // The sweep's state adds the earlier cost.
      report.row.wall_seconds = report.row.processor_seconds = 0;
    }
    store(report);
    if (report.row.status == RunStatus::failed && state_.tries_again(report.row)) {
      progress_.tried(report.row.task);
      log_.failed(report.row, Log::Then::tried_again);
      return;
    }
    progress_.ended(report.row);
    log_.ended(report.row);
    was_interrupted_ = was_interrupted_ || report.row.status == RunStatus::interrupted;
  }

  void withdraw_failure(std::int64_t task, const std::string& machine) {
    if (!state_.tries_again(state_.row(task))) progress_.not_ended(state_.row(task));
    state_.withdraw_failure(task);
    log_.failure_withdrawn(state_.row(task), machine);
  }
};

/// Requests the tasks of the next round from the state of the sweep. Returns false if the rule needs no
/// further round.
bool begin_round(results::SeedRule& rule, results::SweepState& state) {
  std::vector<std::int64_t> next = rule.next_round([&](std::int64_t task) { return state.row(task).status; });
  // An earlier call with a higher precision may have started more tasks than this call needs. These tasks are
  // finished, too.
  if (next.empty()) next = state.tasks_begun();
  if (next.empty()) return false;
  state.want(next);
  return true;
}

}  // namespace

int drive_sweep(const scheduler::Communicator& ranks, const DriverOptions& options, const sweep::Plan& plan,
                const sweep::JobFactory& make_job, results::SweepState& state, results::SeedRule* rule) {
  const bool computes = scheduler::computes(ranks.size(), options.master_computes);
  const int computing_ranks = ranks.size() - (computes ? 0 : 1);
  if (options.log != Log::Level::quiet)
    announce(options.output, plan, state, rule != nullptr, computing_ranks);
  const sweep::GroupOf group_of = [&plan](std::int64_t task) { return plan.group_of(task); };
  Driver driver(options, group_of, state, computing_ranks);
  state.watch_ranks(computing_ranks);
  scheduler::Schedule schedule(scheduler::TaskOrder(group_of),
                               ranks.gather(scheduler::Communicator::host_name()), computes);
  scheduler::SweepEnd end = scheduler::SweepEnd::complete;
  bool is_complete = true;
  while (true) {
    const std::vector<std::int64_t> tasks = state.tasks_left();
    driver.expect(tasks);
    schedule.tasks.add(tasks);
    end = scheduler::run_tasks(ranks, schedule, make_job, driver.events(), options.report_interval);
    is_complete = end == scheduler::SweepEnd::complete && !driver.was_interrupted();
    const bool has_more = is_complete && rule && begin_round(*rule, state);
    ranks.broadcast(static_cast<int>(has_more ? AfterRound::another : AfterRound::over));
    if (!has_more) break;
  }
  driver.finish();
  if (is_complete && rule && options.log != Log::Level::quiet) console::say(results::outcome(*rule, plan));
  if (const sweep::RunRow* first = is_complete ? state.first_if_all_failed() : nullptr) {
    console::say("clogsweep: every run has failed; the first one: " + first->message);
    return console::exit_internal_fault;
  }
  if (is_complete) return console::exit_success;
  const bool no_machine_left = end == scheduler::SweepEnd::no_machine_left;
  console::say(fmt::format("clogsweep: {}; the same command resumes the sweep. Results so far are in {}",
                           no_machine_left ? "every machine was set aside, see above: check these machines"
                                           : fmt::format("stopped by {}", driver.reason_to_stop()),
                           options.output));
  return no_machine_left ? console::exit_internal_fault : console::exit_incomplete;
}

void follow_sweep(const scheduler::Communicator& ranks, const sweep::JobFactory& make_job,
                  std::chrono::milliseconds report_interval) {
  scheduler::Schedule none(scheduler::TaskOrder({}), ranks.gather(scheduler::Communicator::host_name()),
                           false);
  do {
    scheduler::run_tasks(ranks, none, make_job, {}, report_interval);
  } while (AfterRound{ranks.broadcast(0)} == AfterRound::another);
}

}  // namespace clog::scheduler

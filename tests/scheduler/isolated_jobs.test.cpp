/// Tests that the scheduler handles tasks that crash their process, on any number of ranks. Exits with 1 on
/// the first fault.

#include "clog/scheduler/isolated_jobs.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <fstream>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "clog/core/tools/error.hpp"
#include "clog/scheduler/scheduler.hpp"
#include "support.hpp"

namespace {

using namespace clog;

/// For each task that crashes, the signal and the words in its row. With the signal 0 the task exits with
/// code 3.
const std::map<std::int64_t, std::pair<int, std::string>> crashes = {
    {3, {SIGSEGV, "its process was ended by SIGSEGV (Segmentation fault)"}},
    {8, {SIGFPE, "its process was ended by SIGFPE (Floating point exception)"}},
    {17, {SIGABRT, "its process was ended by SIGABRT (Aborted)"}},
    {29, {SIGKILL, "its process was ended by SIGKILL (Killed, as the kernel does when memory runs out)"}},
    {34, {0, "its process exited with code 3"}},
};

/// Tasks with this number or a larger one are slow, so that a rank requests their progress.
constexpr std::int64_t first_slow_task = 60;

/// Tasks with this number or a larger one stop their process in their first slice, for ever.
constexpr std::int64_t first_hanging_task = 10'000;
/// Tasks with these numbers or larger ones kill or stop the helper of their process.
constexpr std::int64_t first_task_that_kills_the_helper = 20'000;
constexpr std::int64_t first_task_that_stops_the_helper = 30'000;

/// A description that no helper can read.
constexpr std::string_view unreadable = "unreadable jobs";

/// The process of the test itself, before it forks.
const pid_t rank_pid = getpid();

int oom_score_adj() {
  int score = 0;
  std::ifstream("/proc/self/oom_score_adj") >> score;
  return score;
}

/// A job that crashes in its last slice if its task is one of `crashes`. The job's row states which process
/// computed it.
class CrashingJob final : public SyntheticJob {
 public:
  using SyntheticJob::SyntheticJob;
  bool advance() override {
    const std::int64_t task = row().task;
    if (getpid() != rank_pid && task >= first_task_that_stops_the_helper) {
      kill(getppid(), SIGSTOP);
      _exit(0);
    }
    if (getpid() != rank_pid && task >= first_task_that_kills_the_helper) {
      kill(getppid(), SIGKILL);
      while (true) pause();  // This process ends because its helper has ended, and the task has no result.
    }
    if (task >= first_hanging_task && task < first_task_that_kills_the_helper) std::raise(SIGSTOP);
    if (task >= first_slow_task && task < first_hanging_task)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const bool is_over = SyntheticJob::advance();
    if (const auto crash = crashes.find(row().task); is_over && crash != crashes.end()) {
      if (crash->second.first == 0) _exit(3);
      std::raise(crash->second.first);
    }
    return is_over;
  }
  sweep::RunRow row() const override {
    sweep::RunRow row = SyntheticJob::row();
    row.hold.geometry.num_arcs = getpid();
    row.time = oom_score_adj();
    return row;
  }
};

sweep::JobFactory describe(const std::string& description) {
  if (getpid() != rank_pid && description == unreadable) throw Error("the description is unreadable");
  expect(description == "crashing jobs" || description == unreadable, "the description arrives");
  return [](std::int64_t task, std::span<const std::byte> snapshot) {
    return std::make_unique<CrashingJob>(task, snapshot);
  };
}

void a_crash_fails_its_task_and_no_other(const scheduler::Communicator& ranks,
                                         const sweep::JobFactory& make_job) {
  constexpr std::int64_t num_tasks = first_slow_task;
  std::map<std::int64_t, sweep::RunRow> rows;
  std::map<std::int64_t, std::set<std::int64_t>> processes;  // by rank, the processes of tasks that succeeded
  std::map<std::int64_t, std::int64_t> attempts;
  scheduler::SweepEvents events;
  events.started = [&](std::int64_t task, int) { return scheduler::Start{{}, ++attempts[task]}; };
  events.tries_again = [](const sweep::RunRow& failed) { return failed.attempt < 2; };
  events.failure_withdrawn = [&](std::int64_t task, const std::string&) { --attempts[task]; };
  events.ended = [&](const scheduler::Report& report) {
    rows[report.row.task] = report.row;
    if (report.row.status == RunStatus::clogged)
      processes[report.row.rank].insert(report.row.hold.geometry.num_arcs);
  };
  const scheduler::SweepEnd end = run_once(ranks, scheduler::order_of(num_tasks, 7), make_job, events, true);
  if (ranks.rank() != 0) return;
  expect(end == scheduler::SweepEnd::complete && rows.size() == num_tasks, "the sweep goes on");
  for (const auto& [task, row] : rows) {
    const auto crash = crashes.find(task);
    expect(row.status == (crash == crashes.end() ? RunStatus::clogged : RunStatus::failed),
           "who crashes fails, and nobody else");
    expect(row.message == (crash == crashes.end() ? "" : crash->second.second),
           "the row says how it crashed");
    expect(row.attempt == (crash == crashes.end() ? 1 : 2), "a task that crashed was tried again");
    if (crash == crashes.end())
      expect(row.distance == static_cast<double>(task * task), "a row holds its own task's result");
    if (crash == crashes.end())
      expect(row.time == 1000, "when memory runs out, a process that computes goes first");
  }
  std::size_t num_processes = 0;
  for (const auto& [rank, of_rank] : processes) {
    expect(!of_rank.contains(getpid()), "no rank computes itself");
    num_processes += of_rank.size();
  }
  // A task that crashes is tried twice. If its rank may be the cause, the task is tried once more.
  expect(num_processes <= ranks.size() + 3 * crashes.size(), "a process serves many tasks");
}

void a_stopped_task_goes_on_from_its_snapshot(const scheduler::Communicator& ranks,
                                              const sweep::JobFactory& make_job) {
  std::map<std::int64_t, scheduler::Report> stopped;
  int num_reports = 0;
  scheduler::SweepEvents events;
  events.progressed = [&](const scheduler::Report& report) {
    ++num_reports;
    expect(report.row.status == RunStatus::running, "a report is of a running task");
    expect(report.snapshot.size() == static_cast<std::size_t>(report.row.steps), "a report has its snapshot");
  };
  events.ended = [&](const scheduler::Report& report) {
    if (report.row.status != RunStatus::interrupted) return;
    expect(report.snapshot.size() == static_cast<std::size_t>(report.row.steps),
           "a stopped task has its snapshot");
    stopped[report.row.task] = report;
  };
  events.stop_requested = [&] { return num_reports > 0; };
  std::vector<std::int64_t> tasks(1000);
  std::iota(tasks.begin(), tasks.end(), first_slow_task);
  const scheduler::SweepEnd end =
      run_once(ranks, scheduler::order_of(tasks, 1), make_job, events, true, std::chrono::milliseconds(1));
  expect(ranks.rank() != 0 || end == scheduler::SweepEnd::stopped, "a stop stops");
  std::vector<std::int64_t> left;
  left.reserve(stopped.size());
  for (const auto& [task, report] : stopped) left.push_back(task);
  std::size_t num_ended = 0;
  events = scheduler::SweepEvents();
  events.started = [&](std::int64_t task, int) { return scheduler::Start{stopped.at(task).snapshot, 1}; };
  events.ended = [&](const scheduler::Report& report) {
    ++num_ended;
    expect(report.row.status == RunStatus::clogged, "a task goes on to its end");
    expect(report.row.steps == 1 + report.row.task * 7 % 5, "no slice is done twice");
  };
  run_once(ranks, scheduler::order_of(left, 1), make_job, events, true);
  expect(num_ended == left.size(), "every stopped task goes on");
}

void hanging_tasks_block_nobody(const scheduler::Communicator& ranks, const sweep::JobFactory& make_job) {
  // Every rank computes one task that hangs. Reports are so frequent that each rank is always waiting for a
  // report.
  std::vector<std::int64_t> tasks(ranks.size());
  std::iota(tasks.begin(), tasks.end(), first_hanging_task);
  const std::vector<std::byte> snapshot(3);
  int num_started = 0;
  int num_idle = 0;
  std::size_t num_stopped = 0;
  scheduler::SweepEvents events;
  events.started = [&](std::int64_t, int) {
    ++num_started;
    return scheduler::Start{snapshot, 1};
  };
  events.idle = [&] { num_idle += num_started == ranks.size(); };
  events.stop_requested = [&] { return num_idle > 3; };
  events.ended = [&](const scheduler::Report& report) {
    ++num_stopped;
    expect(report.row.status == RunStatus::interrupted, "a task that hangs can be stopped");
    expect(report.snapshot == snapshot, "the last known snapshot is kept");
  };
  const scheduler::SweepEnd end =
      run_once(ranks, scheduler::order_of(tasks, 1), make_job, events, true, std::chrono::milliseconds(1));
  expect(ranks.rank() != 0 || (end == scheduler::SweepEnd::complete && num_stopped == tasks.size()),
         "a stop ends all tasks that hang");
  std::iota(tasks.begin(), tasks.end(), first_slow_task);
  events = scheduler::SweepEvents();
  events.ended = [&](const scheduler::Report& report) {
    expect(report.row.status == RunStatus::clogged, "the next task gets a process that does not hang");
  };
  run_once(ranks, scheduler::order_of(tasks, 1), make_job, events, true);
}

void a_rank_goes_on_without_its_helper(const scheduler::Communicator& ranks,
                                       const sweep::JobFactory& make_job, std::int64_t first_task) {
  std::vector<std::int64_t> tasks(40);
  std::iota(tasks.begin(), tasks.end(), first_task);
  std::map<std::int64_t, std::string> status;
  std::map<std::int64_t, int> failures;  // by rank
  scheduler::SweepEvents events;
  events.tries_again = [](const sweep::RunRow&) { return true; };
  events.ended = [&](const scheduler::Report& report) {
    status[report.row.task] = name(report.row.status);
    if (report.row.status == RunStatus::failed) {
      ++failures[report.row.rank];
      expect(report.row.message == "the helper process of its rank was killed or stopped",
             "the row says what happened");
    } else if (report.row.rank == 0) {
      expect(report.row.hold.geometry.num_arcs == rank_pid, "the rank does the work itself");
    }
  };
  const scheduler::SweepEnd end = run_once(ranks, scheduler::order_of(tasks, 1), make_job, events, true);
  if (ranks.rank() != 0) return;
  expect(end == scheduler::SweepEnd::complete && status.size() == tasks.size(), "the sweep goes on");
  for (const auto& [task, last] : status) expect(last == "clogged", "no task is lost");
  expect(!failures.empty(), "a helper died");
  for (const auto& [rank, times] : failures) expect(times == 1, "the loss costs one attempt on each rank");
}

}  // namespace

int main(int argc, char** argv) {
  scheduler::IsolatedJobs isolated(describe);
  scheduler::IsolatedJobs others(describe);
  scheduler::IsolatedJobs without_description(describe);
  const scheduler::Communicator ranks(argc, argv);
  const auto jobs = [](scheduler::IsolatedJobs& of, std::string_view description = "crashing jobs") {
    return of.jobs(std::string(description), describe(std::string(description)));
  };
  const sweep::JobFactory make_job = jobs(isolated);
  a_crash_fails_its_task_and_no_other(ranks, make_job);
  a_stopped_task_goes_on_from_its_snapshot(ranks, make_job);
  hanging_tasks_block_nobody(ranks, make_job);
  a_rank_goes_on_without_its_helper(ranks, make_job, first_task_that_kills_the_helper);
  a_rank_goes_on_without_its_helper(ranks, jobs(others), first_task_that_stops_the_helper);
  a_rank_goes_on_without_its_helper(ranks, jobs(without_description, unreadable), first_slow_task);
  if (ranks.rank() == 0) std::printf("crashes cost one task each on %d ranks\n", ranks.size());
}

/// Tests the scheduler with synthetic tasks, on any number of ranks. Exits with 1 on the first fault.

#include "clog/scheduler/scheduler.hpp"

#include <chrono>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "support.hpp"

namespace {

using namespace clog;

void every_task_comes_back_once(const scheduler::Communicator& ranks, bool master_computes,
                                std::int64_t num_tasks) {
  std::map<std::int64_t, int> times_ended;
  std::map<std::int64_t, int> rows_of_rank;
  scheduler::SweepEvents events;
  events.ended = [&](const scheduler::Report& report) {
    const sweep::RunRow& row = report.row;
    ++times_ended[row.task];
    ++rows_of_rank[row.rank];
    expect(row.distance == static_cast<double>(row.task * row.task), "a row holds its own task's result");
    expect(row.status == RunStatus::clogged, "a task is run to its end");
  };
  const scheduler::SweepEnd end =
      run_once(ranks, scheduler::order_of(num_tasks, 7), make_synthetic_job, events, master_computes);
  if (ranks.rank() != 0) return;
  expect(end == scheduler::SweepEnd::complete, "all tasks were handed out");
  expect(static_cast<std::int64_t>(times_ended.size()) == num_tasks, "no task is lost");
  for (const auto& [task, times] : times_ended) expect(times == 1, "no task is done twice");
  if (num_tasks >= 100)
    for (int rank = master_computes ? 0 : 1; rank < ranks.size(); ++rank)
      expect(rows_of_rank[rank] > 0, "every computing rank does its share");
  if (!master_computes) expect(rows_of_rank[0] == 0, "a serving master does not compute");
}

void a_stop_ends_running_tasks_as_interrupted(const scheduler::Communicator& ranks) {
  int num_ended = 0;
  int num_started = 0;
  bool stop = false;
  scheduler::SweepEvents events;
  events.started = [&](std::int64_t, int) {
    ++num_started;
    return scheduler::Start();
  };
  events.ended = [&](const scheduler::Report&) { stop = ++num_ended >= 10; };
  events.stop_requested = [&] { return stop; };
  const scheduler::SweepEnd end =
      run_once(ranks, scheduler::order_of(10000, 7), make_synthetic_job, events, true);
  if (ranks.rank() != 0) return;
  expect(end == scheduler::SweepEnd::stopped, "a stopped sweep says that tasks are left");
  expect(num_ended == num_started, "every started task has a row");
  expect(num_ended < 10 + 3 * ranks.size(), "a stop is quick");
}

void running_tasks_report_and_go_on_from_there(const scheduler::Communicator& ranks) {
  // The sweep is stopped at its first report, and resumes from the last report.
  std::map<std::int64_t, std::vector<std::byte>> snapshots;
  int num_reports = 0;
  bool stop = false;
  scheduler::SweepEvents events;
  events.progressed = [&](const scheduler::Report& report) {
    ++num_reports;
    expect(report.row.status == RunStatus::running, "a report is of a running task");
    expect(report.snapshot.size() == static_cast<std::size_t>(report.row.steps), "a report has its snapshot");
    stop = true;
  };
  events.ended = [&](const scheduler::Report& report) {
    if (report.row.status == RunStatus::interrupted) snapshots[report.row.task] = report.snapshot;
  };
  events.stop_requested = [&] { return stop; };
  run_once(ranks, scheduler::order_of(1000), make_synthetic_job, events, true, std::chrono::milliseconds(2));
  expect(ranks.rank() != 0 || num_reports > 0, "running tasks report");
  std::vector<std::int64_t> left;
  left.reserve(snapshots.size());
  for (const auto& [task, snapshot] : snapshots) left.push_back(task);
  int num_ended = 0;
  events.stop_requested = [] { return false; };
  events.started = [&](std::int64_t task, int) { return scheduler::Start{snapshots[task], 1}; };
  events.ended = [&](const scheduler::Report& report) {
    ++num_ended;
    expect(report.row.steps == 1 + report.row.task * 7 % 5, "no slice is done twice");
    expect(report.row.status == RunStatus::clogged, "a task goes on to its end");
  };
  run_once(ranks, scheduler::order_of(left, 1), make_synthetic_job, events, true);
  expect(num_ended == static_cast<int>(left.size()), "every interrupted task goes on");
}

/// A job that fails in its first attempts.
class FailingJob final : public sweep::Job {
 public:
  FailingJob(std::int64_t task, bool fails, FailedBy cause = FailedBy::crash)
      : task_(task), fails_(fails), cause_(cause) {}
  bool advance() override { return true; }
  sweep::RunRow row() const override {
    sweep::RunRow row;
    row.task = task_;
    row.status = fails_ ? RunStatus::failed : RunStatus::clogged;
    row.failed_by = fails_ ? cause_ : FailedBy::none;
    if (fails_) row.message = "broken";
    return row;
  }

 private:
  std::int64_t task_;
  bool fails_;
  FailedBy cause_;
};

void failed_tasks_are_tried_again(const scheduler::Communicator& ranks) {
  // Task 3 never succeeds. Task 5 succeeds in its second attempt. A snapshot of one byte marks this attempt.
  std::map<std::int64_t, std::int64_t> attempts;
  std::map<std::int64_t, int> successes;
  const auto make_failing = [](std::int64_t task, std::span<const std::byte> snapshot) {
    return std::make_unique<FailingJob>(task, task == 3 || (task == 5 && snapshot.empty()));
  };
  scheduler::SweepEvents events;
  events.started = [&](std::int64_t task, int) {
    const std::int64_t attempt = ++attempts[task];
    return scheduler::Start{std::vector<std::byte>(attempt - 1), attempt};
  };
  events.tries_again = [](const sweep::RunRow& failed) { return failed.attempt < 3; };
  events.ended = [&](const scheduler::Report& report) {
    expect(report.row.attempt == attempts[report.row.task], "a row says which attempt it was");
    if (report.row.status == RunStatus::clogged) ++successes[report.row.task];
  };
  run_once(ranks, scheduler::order_of(20, 4), make_failing, events, true);
  if (ranks.rank() != 0) return;
  expect(successes.size() == 19 && !successes.contains(3), "what can succeed does");
  expect(attempts[3] == 3, "attempts are limited");
  expect(attempts[5] == 2 && attempts[6] == 1, "no more attempts than needed");
}

void what_fails_everywhere_is_tried_once(const scheduler::Communicator& ranks) {
  // The droplets of half of the tasks cross themselves or diverge. Such a failure is a result: there is no
  // second attempt, and no rank is at fault.
  const auto make_job = [](std::int64_t task, std::span<const std::byte>) {
    return std::make_unique<FailingJob>(task, task % 2 == 0,
                                        task % 4 == 0 ? FailedBy::crossing : FailedBy::divergence);
  };
  std::map<std::int64_t, int> starts, ends;
  scheduler::SweepEvents events;
  events.started = [&](std::int64_t task, int) { return scheduler::Start{{}, ++starts[task]}; };
  events.set_aside = [](const scheduler::MachineTrust::Suspect&) { expect(false, "no host is at fault"); };
  events.failure_withdrawn = [](std::int64_t, const std::string&) {
    expect(false, "no failure is in doubt");
  };
  events.ended = [&](const scheduler::Report& report) { ++ends[report.row.task]; };
  const scheduler::SweepEnd end = run_once(ranks, scheduler::order_of(40, 4), make_job, events, true);
  if (ranks.rank() != 0) return;
  expect(end == scheduler::SweepEnd::complete, "the sweep is complete");
  for (std::int64_t task = 0; task < 40; ++task)
    expect(starts[task] == 1 && ends[task] == 1, "each task has one attempt and one row");
}

/// Makes jobs that fail on broken ranks and take some milliseconds on other ranks. A job fails everywhere if
/// its task is impossible.
sweep::JobFactory failing_on(const scheduler::Communicator& ranks,
                             const std::function<bool(int rank)>& is_broken,
                             const std::function<bool(std::int64_t task)>& is_impossible) {
  return [&ranks, is_broken, is_impossible](
             std::int64_t task, std::span<const std::byte> snapshot) -> std::unique_ptr<sweep::Job> {
    if (is_impossible(task) || is_broken(ranks.rank())) return std::make_unique<FailingJob>(task, true);
    return std::make_unique<SyntheticJob>(task, snapshot);
  };
}

/// The results on rank 0 of a sweep with broken ranks.
struct Outcome {
  scheduler::SweepEnd end;
  std::map<std::int64_t, std::string> status;     // Status in the row of each task.
  std::map<std::int64_t, std::int64_t> attempts;  // Attempts that count, by task.
  std::map<std::int64_t, int> starts;
  std::set<int> set_aside;  // numbers of hosts
};

/// The number of a host, see hosts_of_ranks().
int number_of(const scheduler::MachineTrust::Suspect& machine) {
  expect(machine.name.starts_with("host "), "hosts are set aside");
  return std::stoi(machine.name.substr(5));
}

Outcome sweep(const scheduler::Communicator& ranks, std::int64_t num_tasks, std::int64_t most_attempts,
              const sweep::JobFactory& make_job, int ranks_per_host = 1) {
  Outcome outcome;
  scheduler::SweepEvents events;
  events.started = [&](std::int64_t task, int rank) {
    expect(!outcome.set_aside.contains(rank / ranks_per_host), "who was set aside gets no task");
    ++outcome.starts[task];
    return scheduler::Start{{}, ++outcome.attempts[task]};
  };
  events.tries_again = [&](const sweep::RunRow& failed) { return failed.attempt < most_attempts; };
  events.failure_withdrawn = [&](std::int64_t task, const std::string&) {
    expect(outcome.status[task] == "failed", "a failure that is withdrawn was reported");
    --outcome.attempts[task];
  };
  events.set_aside = [&](const scheduler::MachineTrust::Suspect& machine) {
    expect(machine.message == "broken", "the host's last failure comes along");
    expect(outcome.set_aside.insert(number_of(machine)).second, "nobody is set aside twice");
  };
  events.ended = [&](const scheduler::Report& report) {
    outcome.status[report.row.task] = name(report.row.status);
  };
  outcome.end = run_once(ranks, scheduler::order_of(num_tasks, 5), make_job, events, true,
                         std::chrono::seconds(10), ranks_per_host);
  return outcome;
}

const auto never = [](std::int64_t) { return false; };

void a_broken_rank_is_set_aside_and_its_tasks_done_elsewhere(const scheduler::Communicator& ranks,
                                                             std::int64_t most_attempts) {
  const int broken = ranks.size() - 1;
  const auto make_job = failing_on(
      ranks, [=](int rank) { return rank == broken; }, never);
  const Outcome outcome = sweep(ranks, 60, most_attempts, make_job);
  if (ranks.rank() != 0) return;
  expect(outcome.end == scheduler::SweepEnd::complete, "the sweep goes on without it");
  expect(outcome.set_aside == std::set<int>{broken}, "the broken rank, and no other, is set aside");
  for (const auto& [task, status] : outcome.status)
    expect(status == "clogged", "its tasks succeed elsewhere");
  for (const auto& [task, attempts] : outcome.attempts)
    expect(attempts <= most_attempts, "attempts are limited");
}

void a_broken_host_is_set_aside_with_all_its_ranks(const scheduler::Communicator& ranks,
                                                   std::int64_t most_attempts) {
  const int ranks_per_host = ranks.size() / 2;
  const auto make_job = failing_on(
      ranks, [=](int rank) { return rank >= ranks_per_host; }, never);
  const Outcome outcome = sweep(ranks, 60, most_attempts, make_job, ranks_per_host);
  if (ranks.rank() != 0) return;
  expect(outcome.end == scheduler::SweepEnd::complete, "the sweep goes on without the host");
  expect(outcome.set_aside == std::set<int>{1}, "the broken host, and no other, is set aside");
  expect(outcome.status.size() == 60, "every task has a row");
  for (const auto& [task, status] : outcome.status) expect(status == "clogged", "tasks succeed elsewhere");
  for (const auto& [task, starts] : outcome.starts) expect(starts <= 2, "a retry goes to the other host");
}

void who_was_set_aside_stays_so_in_the_next_round(const scheduler::Communicator& ranks) {
  const int broken = ranks.size() - 1;
  const auto make_job = failing_on(
      ranks, [=](int rank) { return rank == broken; }, never);
  std::set<int> set_aside;
  scheduler::SweepEvents events;
  events.started = [&](std::int64_t, int rank) {
    expect(!set_aside.contains(rank), "who was set aside gets no task in any round");
    return scheduler::Start();
  };
  events.set_aside = [&](const auto& machine) { set_aside.insert(number_of(machine)); };
  scheduler::Schedule schedule(scheduler::order_of(0, 5), hosts_of_ranks(ranks.size(), 1), true);
  for (std::int64_t round = 0; round < 3; ++round) {
    std::vector<std::int64_t> tasks(30);
    std::iota(tasks.begin(), tasks.end(), 30 * round);
    schedule.tasks.add(tasks);
    scheduler::run_tasks(ranks, schedule, make_job, events);
    expect(ranks.rank() != 0 || set_aside == std::set<int>{broken}, "the broken rank is set aside");
  }
}

void most_ranks_may_be_broken(const scheduler::Communicator& ranks) {
  // Each task has only one attempt, so all tasks can succeed only if failures on broken ranks do not count.
  const auto make_job = failing_on(
      ranks, [](int rank) { return rank > 0; }, never);
  const Outcome outcome = sweep(ranks, 60, 1, make_job);
  if (ranks.rank() != 0) return;
  expect(outcome.end == scheduler::SweepEnd::complete, "one good rank is enough");
  expect(outcome.set_aside.size() == static_cast<std::size_t>(ranks.size()) - 1, "all others are set aside");
  for (const auto& [task, status] : outcome.status) expect(status == "clogged", "all tasks succeed");
}

void impossible_tasks_are_no_rank_to_blame(const scheduler::Communicator& ranks) {
  const auto none = [](int) { return false; };
  const auto some = [](std::int64_t task) { return task % 5 == 2 || task % 5 == 3; };
  const auto all = [](std::int64_t) { return true; };
  for (const std::function<bool(std::int64_t)>& is_impossible :
       {std::function<bool(std::int64_t)>(some), std::function<bool(std::int64_t)>(all)}) {
    const Outcome outcome = sweep(ranks, 60, 2, failing_on(ranks, none, is_impossible));
    if (ranks.rank() != 0) continue;
    expect(outcome.end == scheduler::SweepEnd::complete, "the sweep comes to its end");
    expect(outcome.set_aside.empty(), "no rank is set aside");
    expect(outcome.status.size() == 60, "every task has a row");
    for (const auto& [task, status] : outcome.status)
      expect(status == (is_impossible(task) ? "failed" : "clogged"), "what can succeed does");
    for (const auto& [task, starts] : outcome.starts)
      expect(starts <= (is_impossible(task) ? 2 + 2 * ranks.size() : 1),
             "no more attempts than needed, in doubt two more on each rank");
  }
}

void a_sweep_without_a_rank_that_works_ends(const scheduler::Communicator& ranks) {
  // Rank 0 breaks after all other ranks have been set aside.
  int num_done = 0;
  const auto make_job = failing_on(
      ranks, [&](int rank) { return rank > 0 || ++num_done > 60; }, never);
  const Outcome outcome = sweep(ranks, 200, 2, make_job);
  if (ranks.rank() != 0) return;
  expect(outcome.end == scheduler::SweepEnd::no_machine_left, "a sweep that no rank can do ends");
  expect(outcome.set_aside.size() == static_cast<std::size_t>(ranks.size()), "all are set aside");
}

}  // namespace

int main(int argc, char** argv) {
  const scheduler::Communicator ranks(argc, argv);
  expect(ranks.broadcast(std::string(ranks.rank() == 0 ? "a word" : "")) == "a word",
         "a word reaches every rank");
  expect(ranks.broadcast(ranks.rank() == 0 ? 7 : 0) == 7, "a number reaches every rank");
  expect(scheduler::computes(1, scheduler::MasterComputes::no), "a single rank must compute");
  expect(scheduler::computes(4, scheduler::MasterComputes::automatic), "a few ranks: the master computes");
  expect(!scheduler::computes(400, scheduler::MasterComputes::automatic), "many ranks: the master serves");
  every_task_comes_back_once(ranks, true, 200);
  if (ranks.size() > 1) every_task_comes_back_once(ranks, false, 200);
  every_task_comes_back_once(ranks, true, 1);
  every_task_comes_back_once(ranks, true, 0);
  a_stop_ends_running_tasks_as_interrupted(ranks);
  running_tasks_report_and_go_on_from_there(ranks);
  what_fails_everywhere_is_tried_once(ranks);
  failed_tasks_are_tried_again(ranks);
  impossible_tasks_are_no_rank_to_blame(ranks);
  if (ranks.size() > 1) {
    a_broken_rank_is_set_aside_and_its_tasks_done_elsewhere(ranks, 1);
    a_broken_rank_is_set_aside_and_its_tasks_done_elsewhere(ranks, 2);
    for (const std::int64_t most_attempts : {1, 2})
      a_broken_host_is_set_aside_with_all_its_ranks(ranks, most_attempts);
    who_was_set_aside_stays_so_in_the_next_round(ranks);
    most_ranks_may_be_broken(ranks);
    a_sweep_without_a_rank_that_works_ends(ranks);
  }
  if (ranks.rank() == 0) std::printf("scheduler holds on %d ranks\n", ranks.size());
}

/// The scheduler on however many ranks mpirun gives it, with synthetic tasks. Exits with 1 on the first
/// fault.

#include "clog/parallel/scheduler.hpp"

#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <thread>

namespace {

using namespace clog;

void expect(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "failed: %s\n", what);
  std::_Exit(1);
}

/// Takes a number of slices that differs from task to task.
class SyntheticJob final : public sweep::Job {
 public:
  SyntheticJob(std::int64_t task, std::span<const std::byte> snapshot)
      : task_(task), slices_left_(1 + task * 7 % 5 - static_cast<std::int64_t>(snapshot.size())) {}
  bool advance() override {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return --slices_left_ <= 0;
  }
  std::vector<std::byte> snapshot() const override {
    return std::vector<std::byte>(1 + task_ * 7 % 5 - slices_left_);  // as many bytes as slices are done
  }
  sweep::RunRow row() const override {
    sweep::RunRow row;
    row.task = task_;
    row.distance = static_cast<double>(task_ * task_);
    row.status = slices_left_ > 0 ? "interrupted" : "clogged";
    row.steps = 1 + task_ * 7 % 5 - slices_left_;
    return row;
  }

 private:
  std::int64_t task_;
  std::int64_t slices_left_;
};

const sweep::JobFactory make_job = [](std::int64_t task, std::span<const std::byte> snapshot) {
  return std::make_unique<SyntheticJob>(task, snapshot);
};

void every_task_comes_back_once(const parallel::Communicator& ranks, bool master_computes,
                                std::int64_t num_tasks) {
  std::map<std::int64_t, int> times_ended;
  std::map<std::int64_t, int> rows_of_rank;
  parallel::SweepEvents events;
  events.ended = [&](const parallel::Report& report) {
    const sweep::RunRow& row = report.row;
    ++times_ended[row.task];
    ++rows_of_rank[row.rank];
    expect(row.distance == static_cast<double>(row.task * row.task), "a row holds its own task's result");
    expect(row.status.view() == "clogged", "a task is run to its end");
  };
  const bool all =
      parallel::run_tasks(ranks, parallel::TaskOrder(num_tasks, 7), make_job, events, master_computes);
  if (ranks.rank() != 0) return;
  expect(all, "all tasks were handed out");
  expect(static_cast<std::int64_t>(times_ended.size()) == num_tasks, "no task is lost");
  for (const auto& [task, times] : times_ended) expect(times == 1, "no task is done twice");
  if (num_tasks >= 100)
    for (int rank = master_computes ? 0 : 1; rank < ranks.size(); ++rank)
      expect(rows_of_rank[rank] > 0, "every computing rank does its share");
  if (!master_computes) expect(rows_of_rank[0] == 0, "a serving master does not compute");
}

void a_stop_ends_running_tasks_as_interrupted(const parallel::Communicator& ranks) {
  int num_ended = 0;
  int num_started = 0;
  bool stop = false;
  parallel::SweepEvents events;
  events.started = [&](std::int64_t, int) {
    ++num_started;
    return parallel::Start();
  };
  events.ended = [&](const parallel::Report&) { stop = ++num_ended >= 10; };
  events.stop_requested = [&] { return stop; };
  const bool all = parallel::run_tasks(ranks, parallel::TaskOrder(10000, 7), make_job, events, true);
  if (ranks.rank() != 0) return;
  expect(!all, "a stopped sweep says that tasks are left");
  expect(num_ended == num_started, "every started task has a row");
  expect(num_ended < 10 + 3 * ranks.size(), "a stop is quick");
}

void running_tasks_report_and_go_on_from_there(const parallel::Communicator& ranks) {
  // Stopped at its first report, the sweep goes on with what was reported last.
  std::map<std::int64_t, std::vector<std::byte>> snapshots;
  int num_reports = 0;
  bool stop = false;
  parallel::SweepEvents events;
  events.progressed = [&](const parallel::Report& report) {
    ++num_reports;
    expect(report.row.status.view() == "running", "a report is of a running task");
    expect(report.snapshot.size() == static_cast<std::size_t>(report.row.steps), "a report has its snapshot");
    stop = true;
  };
  events.ended = [&](const parallel::Report& report) {
    if (report.row.status.view() == "interrupted") snapshots[report.row.task] = report.snapshot;
  };
  events.stop_requested = [&] { return stop; };
  parallel::run_tasks(ranks, parallel::TaskOrder(1000), make_job, events, true, std::chrono::milliseconds(2));
  expect(ranks.rank() != 0 || num_reports > 0, "running tasks report");
  std::vector<std::int64_t> left;
  for (const auto& [task, snapshot] : snapshots) left.push_back(task);
  int num_ended = 0;
  events.stop_requested = [] { return false; };
  events.started = [&](std::int64_t task, int) { return parallel::Start{snapshots[task], 1}; };
  events.ended = [&](const parallel::Report& report) {
    ++num_ended;
    expect(report.row.steps == 1 + report.row.task * 7 % 5, "no slice is done twice");
    expect(report.row.status.view() == "clogged", "a task goes on to its end");
  };
  parallel::run_tasks(ranks, parallel::TaskOrder(left, 1), make_job, events, true);
  expect(num_ended == static_cast<int>(left.size()), "every interrupted task goes on");
}

/// Fails in its first attempts.
class FailingJob final : public sweep::Job {
 public:
  explicit FailingJob(std::int64_t task, bool fails) : task_(task), fails_(fails) {}
  bool advance() override { return true; }
  sweep::RunRow row() const override {
    sweep::RunRow row;
    row.task = task_;
    row.status = fails_ ? "failed" : "clogged";
    return row;
  }

 private:
  std::int64_t task_;
  bool fails_;
};

void failed_tasks_are_tried_again(const parallel::Communicator& ranks) {
  // Task 3 never succeeds, the others do in their second attempt, which a snapshot of one byte marks here.
  std::map<std::int64_t, std::int64_t> attempts;
  std::map<std::int64_t, int> successes;
  const auto make_failing = [](std::int64_t task, std::span<const std::byte> snapshot) {
    return std::make_unique<FailingJob>(task, task == 3 || snapshot.empty());
  };
  parallel::SweepEvents events;
  events.started = [&](std::int64_t task, int) {
    const std::int64_t attempt = ++attempts[task];
    return parallel::Start{std::vector<std::byte>(attempt - 1), attempt};
  };
  events.tries_again = [](const sweep::RunRow& failed) { return failed.attempt < 3; };
  events.ended = [&](const parallel::Report& report) {
    expect(report.row.attempt == attempts[report.row.task], "a row says which attempt it was");
    if (report.row.status.view() == "clogged") ++successes[report.row.task];
  };
  parallel::run_tasks(ranks, parallel::TaskOrder(20, 4), make_failing, events, true);
  if (ranks.rank() != 0) return;
  expect(successes.size() == 19 && !successes.contains(3), "what can succeed does");
  expect(attempts[3] == 3, "attempts are limited");
  expect(attempts[5] == 2, "no more attempts than needed");
}

}  // namespace

int main(int argc, char** argv) {
  const parallel::Communicator ranks(argc, argv);
  expect(ranks.broadcast(ranks.rank() == 0 ? "a word" : "") == "a word", "a word reaches every rank");
  expect(parallel::computes(1, parallel::MasterComputes::no), "a single rank must compute");
  expect(parallel::computes(4, parallel::MasterComputes::automatic), "a few ranks: the master computes");
  expect(!parallel::computes(400, parallel::MasterComputes::automatic), "many ranks: the master serves");
  every_task_comes_back_once(ranks, true, 200);
  if (ranks.size() > 1) every_task_comes_back_once(ranks, false, 200);
  every_task_comes_back_once(ranks, true, 1);
  every_task_comes_back_once(ranks, true, 0);
  a_stop_ends_running_tasks_as_interrupted(ranks);
  running_tasks_report_and_go_on_from_there(ranks);
  failed_tasks_are_tried_again(ranks);
  if (ranks.rank() == 0) std::printf("scheduler holds on %d ranks\n", ranks.size());
}

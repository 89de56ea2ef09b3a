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
  explicit SyntheticJob(std::int64_t task) : task_(task), slices_left_(1 + task * 7 % 5) {}
  bool advance() override {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return --slices_left_ <= 0;
  }
  sweep::RunRow row() const override {
    sweep::RunRow row;
    row.task = task_;
    row.distance = static_cast<double>(task_ * task_);
    row.status = slices_left_ > 0 ? "interrupted" : "clogged";
    return row;
  }

 private:
  std::int64_t task_;
  std::int64_t slices_left_;
};

const sweep::JobFactory make_job = [](std::int64_t task) { return std::make_unique<SyntheticJob>(task); };

void every_task_comes_back_once(const parallel::Communicator& ranks, bool master_computes,
                                std::int64_t num_tasks) {
  std::map<std::int64_t, int> times_ended;
  std::map<std::int64_t, int> rows_of_rank;
  parallel::SweepEvents events;
  events.ended = [&](const sweep::RunRow& row) {
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
  events.started = [&](std::int64_t, int) { ++num_started; };
  events.ended = [&](const sweep::RunRow&) { stop = ++num_ended >= 10; };
  events.stop_requested = [&] { return stop; };
  const bool all = parallel::run_tasks(ranks, parallel::TaskOrder(10000, 7), make_job, events, true);
  if (ranks.rank() != 0) return;
  expect(!all, "a stopped sweep says that tasks are left");
  expect(num_ended == num_started, "every started task has a row");
  expect(num_ended < 10 + 3 * ranks.size(), "a stop is quick");
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
  if (ranks.rank() == 0) std::printf("scheduler holds on %d ranks\n", ranks.size());
}

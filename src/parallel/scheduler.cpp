#include "clog/parallel/scheduler.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <optional>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

namespace clog::parallel {
namespace {

using sweep::Job;
using sweep::JobFactory;
using sweep::RunRow;
using Clock = std::chrono::steady_clock;

enum Tag : int {
  ready = 1,  // worker -> master: give me a task (empty)
  row,        // worker -> master: a RunRow, and give me a task
  task,       // master -> worker: a task's number, or no_more_tasks
  stop,       // master -> worker: end the present task as interrupted (empty)
};
constexpr std::int64_t no_more_tasks = -1;

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  return std::as_bytes(std::span(&value, 1));
}

template <class T>
T from_bytes(const std::vector<std::byte>& bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

/// Sleeps a little longer each time nothing happened.
class Backoff {
 public:
  void sleep() {
    std::this_thread::sleep_for(pause_);
    pause_ = std::min(2 * pause_, longest);
  }
  void reset() { pause_ = shortest; }

 private:
  static constexpr std::chrono::microseconds shortest{20};
  static constexpr std::chrono::microseconds longest{5000};
  std::chrono::microseconds pause_ = shortest;
};

RunRow signed_row(const Job& job, int rank) {
  RunRow result = job.row();
  result.rank = rank;
  result.host = Communicator::host_name();
  return result;
}

class Master {
 public:
  Master(const Communicator& ranks, TaskOrder tasks, const JobFactory& make_job, const SweepEvents& events,
         bool computes)
      : ranks_(ranks),
        tasks_(std::move(tasks)),
        make_job_(make_job),
        events_(events),
        computes_(computes),
        busy_(ranks.size(), false) {}

  bool run() {
    const int num_workers = ranks_.size() - 1;
    Backoff backoff;
    while (num_dismissed_ < num_workers || own_job_ || (computes_ && has_task())) {
      const bool served = serve();
      const bool worked = work();
      if (Clock::now() - last_idle_ > std::chrono::milliseconds(100)) {
        last_idle_ = Clock::now();
        events_.idle();
      }
      if (!stopping_ && events_.stop_requested()) stop_workers();
      if (served || worked)
        backoff.reset();
      else
        backoff.sleep();
    }
    return tasks_.empty();
  }

 private:
  const Communicator& ranks_;
  TaskOrder tasks_;
  const JobFactory& make_job_;
  const SweepEvents& events_;
  bool computes_;
  bool stopping_ = false;
  int num_dismissed_ = 0;
  std::vector<bool> busy_;
  std::unique_ptr<Job> own_job_;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_idle_ = begin_;

  bool has_task() const { return !stopping_ && !tasks_.empty(); }

  double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  std::int64_t take_task(int rank) {
    const std::int64_t next = tasks_.take(seconds());
    events_.started(next, rank);
    return next;
  }

  /// Answers every waiting message. Returns whether there was one.
  bool serve() {
    bool served = false;
    while (const auto envelope = ranks_.probe(Communicator::any, Communicator::any)) {
      served = true;
      const std::vector<std::byte> bytes = ranks_.receive(*envelope);
      const int worker = envelope->source;
      std::optional<RunRow> result;
      if (envelope->tag == row) {
        result = from_bytes<RunRow>(bytes);
        tasks_.ended(result->task, seconds());
      }
      busy_[worker] = has_task();
      const std::int64_t next = busy_[worker] ? take_task(worker) : no_more_tasks;
      ranks_.send(worker, task,
                  bytes_of(next));  // first the task, then the file: workers do not wait for the disk
      if (next == no_more_tasks) ++num_dismissed_;
      if (result) events_.ended(*result);
    }
    return served;
  }

  /// One slice of this rank's own task. Returns whether there was one.
  bool work() {
    if (!computes_) return false;
    if (!own_job_) {
      if (!has_task()) return false;
      own_job_ = make_job_(take_task(ranks_.rank()));
    }
    if (own_job_->advance() || stopping_) {
      const RunRow result = signed_row(*own_job_, ranks_.rank());
      own_job_.reset();
      tasks_.ended(result.task, seconds());
      events_.ended(result);
    }
    return true;
  }

  void stop_workers() {
    stopping_ = true;
    for (int worker = 1; worker < ranks_.size(); ++worker)
      if (busy_[worker]) ranks_.send(worker, stop, {});
  }
};

class Worker {
 public:
  Worker(const Communicator& ranks, const JobFactory& make_job) : ranks_(ranks), make_job_(make_job) {}

  void run() {
    ranks_.send(master, ready, {});
    for (std::int64_t next = wait_for_task(); next != no_more_tasks; next = wait_for_task()) {
      const std::unique_ptr<Job> job = make_job_(next);
      bool stopped = false;
      while (!stopped && !job->advance()) stopped = take_stop();
      const RunRow result = signed_row(*job, ranks_.rank());
      ranks_.send(master, row, bytes_of(result));
    }
    take_stop();  // one that crossed our last row
  }

 private:
  static constexpr int master = 0;
  const Communicator& ranks_;
  const JobFactory& make_job_;

  std::int64_t wait_for_task() const {
    Backoff backoff;
    while (true) {
      if (const auto envelope = ranks_.probe(master, task))
        return from_bytes<std::int64_t>(ranks_.receive(*envelope));
      backoff.sleep();
    }
  }

  bool take_stop() const {
    const auto envelope = ranks_.probe(master, stop);
    if (envelope) ranks_.receive(*envelope);
    return envelope.has_value();
  }
};

}  // namespace

bool computes(int num_ranks, MasterComputes choice) {
  constexpr int most_ranks = 16;
  return num_ranks == 1 || choice == MasterComputes::yes ||
         (choice == MasterComputes::automatic && num_ranks <= most_ranks);
}

bool run_tasks(const Communicator& ranks, TaskOrder tasks, const JobFactory& make_job,
               const SweepEvents& events, bool master_computes) {
  bool all_handed_out = true;
  if (ranks.rank() == 0)
    all_handed_out = Master(ranks, std::move(tasks), make_job, events, master_computes).run();
  else
    Worker(ranks, make_job).run();
  // Workers done early wait here: a message to the next sweep must not reach the master of this one, and
  // MPI_Finalize would keep their cores busy.
  ranks.wait_for_all();
  return all_handed_out;
}

}  // namespace clog::parallel

#include "clog/parallel/scheduler.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <optional>
#include <thread>
#include <type_traits>
#include <unordered_map>
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
  ended,      // worker -> master: a Report, and give me a task
  running,    // worker -> master: a Report
  task,       // master -> worker: a task's number, or no_more_tasks, and the snapshot to begin at
  stop,       // master -> worker: end the present task as interrupted (empty)
};
constexpr std::int64_t no_more_tasks = -1;

/// A message: a plain value and a snapshot, which may be empty.
template <class T>
std::vector<std::byte> to_bytes(const T& value, std::span<const std::byte> snapshot) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<std::byte> bytes(sizeof value + snapshot.size());
  std::memcpy(bytes.data(), &value, sizeof value);
  std::copy(snapshot.begin(), snapshot.end(), bytes.begin() + sizeof value);
  return bytes;
}

template <class T>
std::pair<T, std::vector<std::byte>> from_bytes(const std::vector<std::byte>& bytes) {
  std::pair<T, std::vector<std::byte>> message;
  std::memcpy(&message.first, bytes.data(), sizeof(T));
  message.second.assign(bytes.begin() + sizeof(T), bytes.end());
  return message;
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

/// A task being worked on by this rank, which reports on it from time to time.
class Work {
 public:
  Work(std::unique_ptr<Job> job, int rank, std::chrono::milliseconds report_interval)
      : job_(std::move(job)), rank_(rank), interval_(report_interval) {}

  bool advance() { return job_->advance(); }
  Report report() const {
    Report report{job_->row(), {}};
    report.row.rank = rank_;
    report.row.host = Communicator::host_name();
    if (report.row.status.view() == "interrupted") report.snapshot = job_->snapshot();
    return report;
  }
  std::optional<Report> due_report() {
    if (Clock::now() - last_report_ < interval_) return std::nullopt;
    last_report_ = Clock::now();
    Report now = report();
    now.row.status = "running";
    return now;
  }

 private:
  std::unique_ptr<Job> job_;
  int rank_;
  std::chrono::milliseconds interval_;
  Clock::time_point last_report_ = Clock::now();
};

class Master {
 public:
  Master(const Communicator& ranks, TaskOrder tasks, const JobFactory& make_job, const SweepEvents& events,
         bool computes, std::chrono::milliseconds report_interval)
      : ranks_(ranks),
        tasks_(std::move(tasks)),
        make_job_(make_job),
        events_(events),
        computes_(computes),
        report_interval_(report_interval),
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
  std::chrono::milliseconds report_interval_;
  bool stopping_ = false;
  int num_dismissed_ = 0;
  std::vector<bool> busy_;
  std::optional<Work> own_job_;
  std::unordered_map<std::int64_t, std::int64_t> attempts_;  // of the tasks that run
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_idle_ = begin_;

  bool has_task() const { return !stopping_ && !tasks_.empty(); }

  double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  struct Beginning {
    std::int64_t task = no_more_tasks;
    std::vector<std::byte> snapshot;
  };
  Beginning take_task(int rank) {
    const std::int64_t next = tasks_.take(seconds());
    Start start = events_.started(next, rank);
    attempts_[next] = start.attempt;
    return {next, std::move(start.snapshot)};
  }

  /// What there is to do at once when a task has ended.
  void take_back(Report& report) {
    const std::int64_t ended = report.row.task;
    report.row.attempt = attempts_[ended];
    attempts_.erase(ended);
    tasks_.ended(ended, seconds());
    if (report.row.status.view() == "failed" && events_.tries_again(report.row)) tasks_.put_back(ended);
  }

  /// Answers every waiting message. Returns whether there was one.
  bool serve() {
    bool served = false;
    while (const auto envelope = ranks_.probe(Communicator::any, Communicator::any)) {
      served = true;
      const std::vector<std::byte> bytes = ranks_.receive(*envelope);
      const int worker = envelope->source;
      std::optional<Report> report;
      if (envelope->tag != ready) {
        auto [row, snapshot] = from_bytes<RunRow>(bytes);
        report = Report{row, std::move(snapshot)};
      }
      if (envelope->tag == running) {
        report->row.attempt = attempts_[report->row.task];
        events_.progressed(*report);
        continue;
      }
      if (report) take_back(*report);
      // A failed task is told of before it is taken again.
      if (report && report->row.status.view() == "failed")
        events_.ended(*std::exchange(report, std::nullopt));
      busy_[worker] = has_task();
      const Beginning next = busy_[worker] ? take_task(worker) : Beginning();
      // First the task, then the file: workers do not wait for the disk.
      ranks_.send(worker, task, to_bytes(next.task, next.snapshot));
      if (!busy_[worker]) ++num_dismissed_;
      if (report) events_.ended(*report);
    }
    return served;
  }

  /// One slice of this rank's own task. Returns whether there was one.
  bool work() {
    if (!computes_) return false;
    if (!own_job_) {
      if (!has_task()) return false;
      const Beginning next = take_task(ranks_.rank());
      own_job_.emplace(make_job_(next.task, next.snapshot), ranks_.rank(), report_interval_);
    }
    if (own_job_->advance() || stopping_) {
      Report report = own_job_->report();
      own_job_.reset();
      take_back(report);
      events_.ended(report);
    } else if (std::optional<Report> report = own_job_->due_report()) {
      report->row.attempt = attempts_[report->row.task];
      events_.progressed(*report);
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
  Worker(const Communicator& ranks, const JobFactory& make_job, std::chrono::milliseconds report_interval)
      : ranks_(ranks), make_job_(make_job), report_interval_(report_interval) {}

  void run() {
    ranks_.send(master, ready, {});
    while (true) {
      const auto [next, snapshot] = wait_for_task();
      if (next == no_more_tasks) break;
      Work work(make_job_(next, snapshot), ranks_.rank(), report_interval_);
      bool stopped = false;
      while (!stopped && !work.advance()) {
        stopped = take_stop();
        if (const std::optional<Report> report = work.due_report()) send(running, *report);
      }
      send(ended, work.report());
    }
    take_stop();  // one that crossed our last report
  }

 private:
  static constexpr int master = 0;
  const Communicator& ranks_;
  const JobFactory& make_job_;
  std::chrono::milliseconds report_interval_;

  void send(Tag tag, const Report& report) const {
    ranks_.send(master, tag, to_bytes(report.row, report.snapshot));
  }

  std::pair<std::int64_t, std::vector<std::byte>> wait_for_task() const {
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
               const SweepEvents& events, bool master_computes, std::chrono::milliseconds report_interval) {
  bool all_handed_out = true;
  if (ranks.rank() == 0)
    all_handed_out =
        Master(ranks, std::move(tasks), make_job, events, master_computes, report_interval).run();
  else
    Worker(ranks, make_job, report_interval).run();
  // Workers done early wait here: a message to the next sweep must not reach the master of this one, and
  // MPI_Finalize would keep their cores busy.
  ranks.wait_for_all();
  return all_handed_out;
}

}  // namespace clog::parallel

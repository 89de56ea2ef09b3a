#include "clog/scheduler/scheduler.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "bytes.hpp"

namespace clog::scheduler {
namespace {

using sweep::Job;
using sweep::JobFactory;
using Clock = std::chrono::steady_clock;

enum Tag : int {
  ready = 1,  // worker -> master: requests a task (empty)
  ended,      // worker -> master: a Report; requests a task
  running,    // worker -> master: a Report
  task,       // master -> worker: a task's number, or no_more_tasks, and the task's snapshot
  stop,       // master -> worker: end the present task as interrupted (empty)
};
constexpr std::int64_t no_more_tasks = -1;

/// Sleeps a little longer each time, as long as nothing happens.
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

/// A task that this rank computes. The rank reports on it from time to time.
class Work {
 public:
  Work(std::unique_ptr<Job> job, int rank, std::chrono::milliseconds report_interval)
      : job_(std::move(job)), rank_(rank), interval_(report_interval) {}

  bool advance() { return job_->advance(); }
  /// The final report of a task that has ended or must stop.
  Report last_report() {
    constexpr std::chrono::seconds longest_wait{2};
    const Clock::time_point deadline = Clock::now() + longest_wait;
    while (!job_->refresh() && Clock::now() < deadline) job_->advance();
    return report();
  }
  std::optional<Report> due_report() {
    if (Clock::now() - last_report_ < interval_ || !job_->refresh()) return std::nullopt;
    last_report_ = Clock::now();
    Report now = report();
    now.row.status = RunStatus::running;
    return now;
  }

 private:
  std::unique_ptr<Job> job_;
  int rank_;
  std::chrono::milliseconds interval_;
  Clock::time_point last_report_ = Clock::now();

  Report report() const {
    Report report{job_->row(), {}};
    report.row.rank = rank_;
    report.row.host = Communicator::host_name();
    if (report.row.status == RunStatus::interrupted) report.snapshot = job_->snapshot();
    return report;
  }
};

class Master {
 public:
  Master(const Communicator& ranks, Schedule& schedule, const JobFactory& make_job, const SweepEvents& events,
         std::chrono::milliseconds report_interval)
      : ranks_(ranks),
        schedule_(schedule),
        make_job_(make_job),
        events_(events),
        report_interval_(report_interval) {}

  SweepEnd run() {
    const int num_workers = ranks_.size() - 1;
    Backoff backoff;
    while (num_dismissed_ < num_workers || !is_over()) {
      const bool served = serve();
      const bool worked = work();
      answer_waiting();
      if (!worked && nobody_can_work()) schedule_.trust.end_holds();
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
    if (!has_tasks()) return SweepEnd::complete;
    return stopping_ ? SweepEnd::stopped : SweepEnd::no_machine_left;
  }

 private:
  struct Running {
    int rank;
    std::int64_t attempt;
  };

  const Communicator& ranks_;
  Schedule& schedule_;
  std::vector<std::int64_t> failed_tasks_;  // tasks to be tried again
  const JobFactory& make_job_;
  const SweepEvents& events_;
  std::chrono::milliseconds report_interval_;
  bool stopping_ = false;
  int num_dismissed_ = 0;
  std::set<int> waiting_;                              // workers that wait for a task
  std::unordered_map<std::int64_t, Running> running_;  // running tasks, by task
  std::unordered_set<std::int64_t> withdrawn_;  // tasks whose failure is withdrawn, until they begin again
  std::optional<Work> own_job_;
  Clock::time_point last_idle_ = Clock::now();

  bool has_tasks() const { return !schedule_.tasks.empty() || !failed_tasks_.empty(); }
  bool is_over() const {
    return running_.empty() && (stopping_ || !has_tasks() || schedule_.trust.num_in_service() == 0);
  }

  /// Whether tasks remain that no machine can take, because every machine is on hold or waits for a machine
  /// on hold.
  bool nobody_can_work() const {
    const bool all_wait = static_cast<int>(waiting_.size()) + num_dismissed_ == ranks_.size() - 1;
    return running_.empty() && all_wait && !is_over();
  }

  /// The present time on a clock that all rounds share [s].
  static double seconds() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }

  struct Beginning {
    std::int64_t task = no_more_tasks;
    std::vector<std::byte> snapshot;
  };
  /// The next task for this rank; nullopt if there is none at present.
  std::optional<Beginning> take_task(int rank) {
    if (stopping_ || !schedule_.trust.may_work(rank)) return std::nullopt;
    auto failed = std::find_if(failed_tasks_.begin(), failed_tasks_.end(),
                               [&](std::int64_t task) { return schedule_.trust.is_next_for(task, rank); });
    // If no other task is left, a trusted rank retries a failed task instead of idling.
    if (failed == failed_tasks_.end() && schedule_.tasks.empty() && schedule_.trust.is_trusted(rank))
      failed = failed_tasks_.begin();
    std::int64_t next = no_more_tasks;
    if (failed != failed_tasks_.end()) {
      next = *failed;
      failed_tasks_.erase(failed);
      schedule_.tasks.begun_again(next, seconds());
    } else if (!schedule_.tasks.empty()) {
      next = schedule_.tasks.take(seconds());
    } else {
      return std::nullopt;
    }
    Start start = events_.started(next, rank);
    running_[next] = {rank, start.attempt};
    withdrawn_.erase(next);
    return Beginning{next, std::move(start.snapshot)};
  }

  /// Updates the schedule when a task ends. Reports a failure at once, before the task can be handed out
  /// again.
  void take_back(Report& report) {
    const std::int64_t ended = report.row.task;
    const auto [rank, attempt] = running_.extract(ended).mapped();
    report.row.attempt = attempt;
    schedule_.tasks.ended(ended, seconds());
    if (report.row.status == RunStatus::interrupted) return;
    // Runs that diverge or cross themselves do so on every rank, so they are not retried.
    if (!sweep::may_succeed_later(report.row)) {
      for (const auto& suspect : schedule_.trust.succeeded(ended, rank)) doubt(suspect);
      return;
    }
    events_.ended(report);
    if (events_.tries_again(report.row)) failed_tasks_.push_back(ended);
    if (const auto suspect = schedule_.trust.failed(ended, rank, report.row.message)) doubt(*suspect);
  }

  void doubt(const MachineTrust::Suspect& machine) {
    if (machine.is_set_aside) events_.set_aside(machine);
    for (const std::int64_t task : machine.tasks) withdraw_failure(task, machine.name);
  }

  void withdraw_failure(std::int64_t task, const std::string& machine) {
    if (running_.contains(task) || !withdrawn_.insert(task).second)
      return;  // another machine will try the task
    if (std::find(failed_tasks_.begin(), failed_tasks_.end(), task) == failed_tasks_.end())
      failed_tasks_.push_back(task);
    events_.failure_withdrawn(task, machine);
  }

  /// Receives all waiting messages. Returns whether a message was waiting.
  bool serve() {
    bool served = false;
    while (const auto envelope = ranks_.probe(Communicator::any, Communicator::any)) {
      served = true;
      const std::vector<std::byte> bytes = ranks_.receive(*envelope);
      const int worker = envelope->source;
      if (envelope->tag == ready) {
        answer(worker);
        continue;
      }
      Report report = sweep::report_from(bytes);
      if (envelope->tag == running) {
        report.row.attempt = running_.at(report.row.task).attempt;
        events_.progressed(report);
        continue;
      }
      take_back(report);
      // Answer the worker before writing the row: workers do not wait for the disk.
      answer(worker);
      if (!sweep::may_succeed_later(report.row)) events_.ended(report);
    }
    return served;
  }

  /// Gives a worker its next task; if there is none, the worker waits.
  void answer(int worker) {
    const std::optional<Beginning> next = take_task(worker);
    if (next)
      ranks_.send(worker, task, to_bytes(next->task, next->snapshot));
    else
      waiting_.insert(worker);
  }

  void answer_waiting() {
    if (has_tasks())
      for (const int worker : std::exchange(waiting_, {})) answer(worker);
    if (!is_over()) return;
    for (const int worker : std::exchange(waiting_, {})) {
      ranks_.send(worker, task, to_bytes(no_more_tasks, {}));
      ++num_dismissed_;
    }
  }

  /// Computes one slice of this rank's own task. Returns whether it has one.
  bool work() {
    if (!schedule_.master_computes) return false;
    if (!own_job_) {
      const std::optional<Beginning> next = take_task(ranks_.rank());
      if (!next) return false;
      own_job_.emplace(make_job_(next->task, next->snapshot), ranks_.rank(), report_interval_);
    }
    if (own_job_->advance() || stopping_) {
      Report report = own_job_->last_report();
      own_job_.reset();
      take_back(report);
      if (!sweep::may_succeed_later(report.row)) events_.ended(report);
    } else if (std::optional<Report> report = own_job_->due_report()) {
      report->row.attempt = running_.at(report->row.task).attempt;
      events_.progressed(*report);
    }
    return true;
  }

  void stop_workers() {
    stopping_ = true;
    for (const auto& [task, running] : running_)
      if (running.rank != ranks_.rank()) ranks_.send(running.rank, stop, {});
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
      send(ended, work.last_report());
    }
    take_stop();  // discards a stop that rank 0 sent before our last report arrived
  }

 private:
  static constexpr int master = 0;
  const Communicator& ranks_;
  const JobFactory& make_job_;
  std::chrono::milliseconds report_interval_;

  void send(Tag tag, const Report& report) const { ranks_.send(master, tag, to_bytes(report)); }

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

Schedule::Schedule(TaskOrder first, const std::vector<std::string>& hosts, bool with_master)
    : tasks(std::move(first)), master_computes(with_master), trust(hosts, with_master ? 0 : 1) {}

bool computes(int num_ranks, MasterComputes choice) {
  constexpr int most_ranks = 16;
  return num_ranks == 1 || choice == MasterComputes::yes ||
         (choice == MasterComputes::automatic && num_ranks <= most_ranks);
}

SweepEnd run_tasks(const Communicator& ranks, Schedule& schedule, const JobFactory& make_job,
                   const SweepEvents& events, std::chrono::milliseconds report_interval) {
  SweepEnd end = SweepEnd::complete;
  if (ranks.rank() == 0)
    end = Master(ranks, schedule, make_job, events, report_interval).run();
  else
    Worker(ranks, make_job, report_interval).run();
  // Workers that finish early wait here, so that messages of the next round cannot reach the master of this
  // round. (Workers that waited in MPI_Finalize would spin.)
  ranks.wait_for_all();
  return end;
}

}  // namespace clog::scheduler

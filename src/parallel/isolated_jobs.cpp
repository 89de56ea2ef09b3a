#include "clog/parallel/isolated_jobs.hpp"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <span>
#include <stdexcept>
#include <system_error>
#include <tuple>
#include <utility>

#include "bytes.hpp"
#include "socket.hpp"

namespace clog::parallel {
namespace {

using sweep::Job;
using sweep::JobFactory;
using sweep::RunRow;
using Clock = std::chrono::steady_clock;

enum Kind : std::int64_t {
  describe_jobs = 1,  // rank -> helper: the description
  process_ended,      // helper -> rank: an Ending
  begin,              // rank -> process: a task's number and the snapshot to begin at
  report,             // rank -> process: how far is it (empty); and the answer: a row and its snapshot
  over,               // process -> rank: the last row
  drop,               // rank -> process: work no more on this (empty)
};

/// How a process came to its end.
struct Ending {
  int fork_error = 0;  // errno, if it never began
  int wait_status = 0;
};

std::string describe(const Ending& ending) {
  if (ending.fork_error != 0)
    return std::string("no process could be started for it: ") + std::strerror(ending.fork_error);
  if (!WIFSIGNALED(ending.wait_status))
    return "its process left with exit code " + std::to_string(WEXITSTATUS(ending.wait_status));
  const int signal = WTERMSIG(ending.wait_status);
  const char* name = sigabbrev_np(signal);
  const char* meaning = sigdescr_np(signal);
  return "its process was ended by SIG" + std::string(name ? name : std::to_string(signal)) + " (" +
         (meaning ? meaning : "unknown signal") +
         (signal == SIGKILL ? ", as the kernel does when memory runs out)" : ")");
}

/// The process dies when the one that forked it does. Signals that stop a sweep are the rank's business.
void depend_on_parent(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);  // it was quicker
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) std::signal(signal, SIG_IGN);
}

/// The life of a process that computes. An exception that gets out is a crash like any other.
[[noreturn]] void compute(const Socket& rank, const JobFactory& make_job) noexcept {
  std::unique_ptr<Job> job;
  std::int64_t number = 0;
  bool is_over = true;
  while (true) {
    // At least one slice between two messages: a task that is stopped at once has a snapshot, too.
    while (!is_over) {
      is_over = job->advance();
      if (is_over) rank.send(over, number, to_bytes(job->row(), {}));
      if (rank.wait(std::chrono::milliseconds(0))) break;
    }
    const auto message = rank.receive();
    if (!message) _exit(0);
    if (message->kind == begin) {
      const auto [task, snapshot] = from_bytes<std::int64_t>(message->bytes);
      job = make_job(task, snapshot);
      number = message->job;
      is_over = false;
    } else if (message->kind == report) {
      rank.send(report, number, to_bytes(job->row(), job->snapshot()));
    } else {
      job.reset();
      is_over = true;
    }
  }
}

/// The life of the helper: one process after the other, each with a socket that the rank made for it.
[[noreturn]] void start_processes(const Socket& rank, const IsolatedJobs::Describe& describe) noexcept {
  const auto description = rank.receive();
  if (!description) _exit(0);
  const JobFactory make_job =
      describe({reinterpret_cast<const char*>(description->bytes.data()), description->bytes.size()});
  while (true) {
    Socket socket = rank.receive_socket();
    if (!socket.is_open()) _exit(0);
    const pid_t self = getpid();
    const pid_t process = fork();
    if (process == 0) {
      depend_on_parent(self);
      compute(socket, make_job);
    }
    Ending ending{process < 0 ? errno : 0, 0};
    socket.close();
    while (process > 0 && waitpid(process, &ending.wait_status, 0) < 0 && errno == EINTR) continue;
    rank.send(process_ended, 0, to_bytes(ending, {}));
  }
}

}  // namespace

/// The rank's side of its helper and of the process that computes now.
class IsolatedJobs::Processes {
 public:
  explicit Processes(Socket helper) : helper_(std::move(helper)) {}

  void send_description(const std::string& description) const {
    helper_.send(describe_jobs, 0, std::as_bytes(std::span(description)));
  }

  /// Begins a job in a process that lives. Returns its number.
  std::int64_t begin_job(std::int64_t task, std::span<const std::byte> snapshot) {
    // What an earlier job left, or that the process has died since.
    while (process_.is_open() && process_.wait(std::chrono::milliseconds(0)))
      if (!process_.receive()) bury();
    if (!process_.is_open()) {
      auto [mine, theirs] = Socket::pair();
      helper_.send_socket(theirs);
      process_ = std::move(mine);
    }
    process_.send(begin, ++last_job_, to_bytes(task, snapshot));
    return last_job_;
  }

  const Socket& process() const { return process_; }

  /// Returns how the process that has died came to its end.
  Ending bury() {
    process_.close();
    const auto message = helper_.receive();
    if (!message) throw std::runtime_error("the helper that starts the processes of tasks has died");
    return from_bytes<Ending>(message->bytes).first;
  }

 private:
  Socket helper_;
  Socket process_;
  std::int64_t last_job_ = 0;
};

class IsolatedJobs::IsolatedJob final : public Job {
 public:
  IsolatedJob(Processes& processes, const RunRow& row, std::span<const std::byte> snapshot)
      : processes_(processes), number_(processes.begin_job(row.task, snapshot)) {
    last_.row = row;
  }
  ~IsolatedJob() override {
    if (processes_.process().is_open()) processes_.process().send(drop, number_, {});
  }

  bool advance() override {
    constexpr std::chrono::milliseconds slice{5};
    if (!last_.is_over && processes_.process().wait(slice)) receive();
    return last_.is_over;
  }
  RunRow row() const override {
    if (!last_.is_over) {
      processes_.process().send(report, number_, {});
      while (receive() != report && processes_.process().is_open()) continue;
    }
    return last_.row;
  }
  std::vector<std::byte> snapshot() const override { return last_.snapshot; }

 private:
  /// What is known of it, from the process. Asking is not changing, hence `mutable`.
  struct Known {
    RunRow row;
    std::vector<std::byte> snapshot;
    bool is_over = false;
  };
  Processes& processes_;
  std::int64_t number_;
  mutable Known last_;
  Clock::time_point begin_ = Clock::now();

  /// Takes in a message and returns its kind.
  std::int64_t receive() const {
    const auto message = processes_.process().receive();
    if (!message) {
      fail(describe(processes_.bury()));
      return process_ended;
    }
    if (message->job != number_) return 0;  // of an earlier job, which was dropped meanwhile
    std::tie(last_.row, last_.snapshot) = from_bytes<RunRow>(message->bytes);
    last_.is_over = last_.is_over || message->kind == over;
    return message->kind;
  }

  void fail(const std::string& reason) const {
    last_.is_over = true;
    last_.snapshot.clear();
    last_.row.status = "failed";
    last_.row.message = reason;
    last_.row.wall_seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
  }
};

IsolatedJobs::IsolatedJobs(const Describe& describe) : describe_(describe) {
  auto [mine, theirs] = Socket::pair();
  const pid_t self = getpid();
  helper_ = fork();
  if (helper_ < 0) throw std::system_error(errno, std::generic_category(), "cannot start a process");
  if (helper_ == 0) {
    depend_on_parent(self);
    mine.close();
    start_processes(theirs, describe);
  }
  processes_ = std::make_unique<Processes>(std::move(mine));
}

IsolatedJobs::~IsolatedJobs() {
  kill(helper_, SIGKILL);  // the process that computes goes with it
  while (waitpid(helper_, nullptr, 0) < 0 && errno == EINTR) continue;
}

JobFactory IsolatedJobs::jobs(const std::string& description) {
  processes_->send_description(description);
  return [this, make_job = describe_(description)](std::int64_t task, std::span<const std::byte> snapshot) {
    return std::make_unique<IsolatedJob>(*processes_, make_job(task, {})->row(), snapshot);
  };
}

}  // namespace clog::parallel

#include "clog/scheduler/isolated_jobs.hpp"

#include <fmt/core.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "bytes.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/console/signals.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/tools/descriptor.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/sweep/messages.hpp"
#include "socket.hpp"

namespace clog::scheduler {
namespace {

using sweep::Job;
using sweep::JobFactory;
using sweep::RunRow;
using Clock = std::chrono::steady_clock;

enum Kind : std::int64_t {
  describe_jobs = 1,  // rank -> helper: the description
  process_began,      // helper -> rank: the pid, once only the process has its socket; -1 if it did not begin
  process_ended,      // helper -> rank: an Ending
  begin,              // rank -> process: a task's number, and its snapshot
  report,             // rank -> process: requests progress (empty); the answer: a row and its snapshot
  over,               // process -> rank: the last row
  drop,               // rank -> process: drop the job (empty)
};

/// Timeout for answers. A process answers at once, unless it has been suspended.
constexpr std::chrono::milliseconds answer_timeout{2000};
/// Timeout for the start of a process. A start takes long if memory is scarce.
constexpr std::chrono::milliseconds start_timeout{20'000};

/// How a process ended.
struct Ending {
  int fork_error = 0;  // errno of fork(), if there was no process
  int code = 0;        // si_code of SIGCHLD: CLD_EXITED or another
  int status = 0;      // exit code, or number of the signal
};

/// The name of a signal, such as SIGKILL. (sigabbrev_np() needs glibc 2.32.)
std::string name_of(int signal) {
  static constexpr std::pair<int, const char*> deadly[] = {
      {SIGHUP, "HUP"},   {SIGINT, "INT"},   {SIGQUIT, "QUIT"},     {SIGILL, "ILL"},   {SIGTRAP, "TRAP"},
      {SIGABRT, "ABRT"}, {SIGBUS, "BUS"},   {SIGFPE, "FPE"},       {SIGKILL, "KILL"}, {SIGUSR1, "USR1"},
      {SIGSEGV, "SEGV"}, {SIGUSR2, "USR2"}, {SIGPIPE, "PIPE"},     {SIGALRM, "ALRM"}, {SIGTERM, "TERM"},
      {SIGXCPU, "XCPU"}, {SIGXFSZ, "XFSZ"}, {SIGVTALRM, "VTALRM"}, {SIGPROF, "PROF"}, {SIGSYS, "SYS"}};
  const auto* found = std::ranges::find(deadly, signal, &std::pair<int, const char*>::first);
  return "SIG" + (found != std::end(deadly) ? std::string(found->second) : std::to_string(signal));
}

std::string describe(const Ending& ending) {
  if (ending.fork_error != 0)
    return fmt::format("no process could be started for it: {}", std::strerror(ending.fork_error));
  if (ending.code == CLD_EXITED) return fmt::format("its process exited with code {}", ending.status);
  const int signal = ending.status;
  return fmt::format("its process was ended by {} ({}{})", name_of(signal), strsignal(signal),
                     signal == SIGKILL ? ", as the kernel does when memory runs out" : "");
}

/// Makes this process end when its parent ends. Also lets it ignore the signals that stop a sweep, because
/// the rank handles these signals.
void depend_on_parent(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);  // the parent ended before the call
  for (const int signal : console::stop_signals) std::signal(signal, SIG_IGN);
}

/// Libraries of MPI, such as UCX, install handlers for crashes when they are loaded. Such a handler may wait
/// for ever. After this call, a crash ends the process; the same holds for processes that it forks.
void let_crashes_kill() {
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL}) std::signal(signal, SIG_DFL);
}

/// If memory runs out, the kernel should kill this process rather than the helper or the rank, because the
/// sweep cannot continue without these two.
void be_first_when_memory_runs_out() { std::ofstream("/proc/self/oom_score_adj") << 1000; }

/// Main function of a computing process. An uncaught exception is a crash like any other.
[[noreturn]] void compute(const Socket& rank, const JobFactory& make_job) noexcept {
  std::unique_ptr<Job> job;
  std::int64_t number = 0;
  bool is_over = true;
  while (true) {
    // The process computes at least one slice between two messages, so that a task that is stopped at once
    // still has a snapshot.
    while (!is_over) {
      is_over = job->advance();
      if (is_over) rank.send(over, number, sweep::to_bytes({job->row(), {}}));
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
      rank.send(report, number, sweep::to_bytes({job->row(), job->snapshot()}));
    } else {
      job.reset();
      is_over = true;
    }
  }
}

/// Makes the jobs that the rank describes. If this throws, the helper ends with one line, and the rank
/// computes the tasks itself.
JobFactory described_jobs(const IsolatedJobs::Describe& describe, const std::string& description) noexcept {
  try {
    return describe(description);
  } catch (const std::exception& error) {
    console::say(
        fmt::format("no process for tasks can start ({}); their rank computes them itself", error.what()));
    _exit(console::exit_internal_fault);
  }
}

/// Main function of the helper: forks one process after the other. The rank makes a socket for each process.
[[noreturn]] void start_processes(const Socket& rank, const IsolatedJobs::Describe& describe) noexcept {
  const auto description = rank.receive();
  if (!description) _exit(0);
  const auto* text = reinterpret_cast<const char*>(description->bytes.data());
  const JobFactory make_job = described_jobs(describe, {text, description->bytes.size()});
  pid_t last = -1;
  while (true) {
    Socket socket = rank.receive_socket();
    if (!socket.is_open()) _exit(0);
    if (last > 0) waitpid(last, nullptr, 0);
    const pid_t self = getpid();
    const pid_t process = fork();
    if (process == 0) {
      depend_on_parent(self);
      be_first_when_memory_runs_out();
      compute(socket, make_job);
    }
    Ending ending{process < 0 ? errno : 0};
    socket.close();
    rank.send(process_began, 0, to_bytes(process, {}));
    if (process > 0) {
      // The ended process stays a zombie until the rank requests the next process. So its pid is not reused,
      // and the rank cannot kill another process by mistake.
      siginfo_t end{};
      retried([&] { return waitid(P_PID, process, &end, WEXITED | WNOWAIT); });
      ending.code = end.si_code;
      ending.status = end.si_status;
    }
    rank.send(process_ended, 0, to_bytes(ending, {}));
    last = process;
  }
}

}  // namespace

/// The rank's connections to its helper and to the computing process.
class IsolatedJobs::Processes {
 public:
  Processes(Socket helper, pid_t helper_pid) : helper_(std::move(helper)), helper_pid_(helper_pid) {
    helper_.limit_halts(answer_timeout);
  }

  void send_description(const std::string& description) {
    helper_.send(describe_jobs, 0, std::as_bytes(std::span(description)));
  }

  /// Whether the helper is alive. Without the helper, no process can start.
  bool have_helper() const { return helper_.is_open(); }

  /// Starts a job in a process that is alive, or detects that the helper is dead. Returns the job's number.
  std::int64_t begin_job(std::int64_t task, std::span<const std::byte> snapshot) {
    // Discards messages of an earlier job, and detects whether the process has ended since then.
    while (process_.is_open() && process_.wait(std::chrono::milliseconds(0)))
      if (!process_.receive()) bury();
    ++last_job_;
    if (!have_helper()) return last_job_;
    if (!process_.is_open()) start_process();
    if (process_.is_open()) process_.send(begin, last_job_, to_bytes(task, snapshot));
    return last_job_;
  }

  const Socket& process() const { return process_; }

  /// Kills the process, if it is still alive. Returns how the process ended. Returns nullopt if the helper,
  /// which reports the end, has itself ended or hangs; the rank then no longer uses the helper.
  std::optional<Ending> bury() {
    process_.close();
    if (process_id_ > 0)
      kill(process_id_, SIGKILL);  // no other process gets this pid until the helper starts the next process
    if (helper_.wait(answer_timeout))
      if (const auto message = helper_.receive()) return from_bytes<Ending>(message->bytes).first;
    give_up_helper();
    return std::nullopt;
  }

 private:
  Socket helper_;
  pid_t helper_pid_;
  Socket process_;
  pid_t process_id_ = -1;
  std::int64_t last_job_ = 0;

  /// Asks the helper for a new process. After the helper's reply, only the new process holds the other end of
  /// the socket, so the rank can detect the end of this process.
  void start_process() {
    auto [mine, theirs] = Socket::pair();
    mine.limit_halts(answer_timeout);
    helper_.send_socket(theirs);
    const auto began = helper_.wait(start_timeout) ? helper_.receive() : std::nullopt;
    if (!began) return give_up_helper();
    process_id_ = from_bytes<pid_t>(began->bytes).first;
    process_ = std::move(mine);
  }

  void give_up_helper() {
    kill(helper_pid_, SIGKILL);
    helper_.close();
  }
};

class IsolatedJobs::IsolatedJob final : public Job {
 public:
  IsolatedJob(Processes& processes, const RunRow& row, std::span<const std::byte> snapshot)
      : processes_(processes), number_(processes.begin_job(row.task, snapshot)) {
    last_ = {row, {snapshot.begin(), snapshot.end()}};
    if (!processes_.have_helper()) fail(without_helper);
  }
  ~IsolatedJob() override {
    if (!processes_.process().is_open()) return;
    if (is_asked_ && !is_over_)
      processes_.bury();  // the process may never answer
    else
      processes_.process().send(drop, number_, {});
  }

  bool advance() override {
    constexpr std::chrono::milliseconds slice{5};
    if (!is_over_ && processes_.process().wait(slice)) receive();
    return is_over_;
  }
  bool refresh() override {
    if (is_over_ || std::exchange(has_answered_, false)) return true;
    if (!is_asked_) processes_.process().send(report, number_, {});
    is_asked_ = true;
    return false;
  }
  RunRow row() const override { return last_.row; }
  std::vector<std::byte> snapshot() const override { return last_.snapshot; }

 private:
  static constexpr const char* without_helper = "the helper process of its rank was killed or stopped";

  Processes& processes_;
  std::int64_t number_;
  sweep::Report last_;  ///< the initial report, or the last message of the process
  bool is_over_ = false;
  bool is_asked_ = false;
  bool has_answered_ = false;
  Clock::time_point begin_ = Clock::now();

  void receive() {
    const auto message = processes_.process().receive();
    if (!message) {
      const std::optional<Ending> ending = processes_.bury();
      fail(ending ? describe(*ending) : without_helper);
      return;
    }
    if (message->job != number_) return;  // the message is from an earlier job, which was dropped
    last_ = sweep::report_from(message->bytes);
    is_over_ = message->kind == over;
    is_asked_ = false;
    has_answered_ = true;
  }

  void fail(const std::string& reason) {
    is_over_ = true;
    last_.snapshot.clear();
    last_.row.status = RunStatus::failed;
    last_.row.failed_by = FailedBy::crash;
    last_.row.message = reason;
    last_.row.wall_seconds = std::max(0.0, std::chrono::duration<double>(Clock::now() - begin_).count());
    last_.row.processor_seconds = sweep::RunRow::not_known;
  }
};

IsolatedJobs::IsolatedJobs(const Describe& describe) {
  auto [mine, theirs] = Socket::pair();
  const pid_t self = getpid();
  let_crashes_kill();
  helper_ = fork();
  if (helper_ < 0)
    throw Error(std::string("cannot start a process (") + std::strerror(errno) +
                "); end other programs, or raise the limit on processes (ulimit -u)");
  if (helper_ == 0) {
    depend_on_parent(self);
    mine.close();
    start_processes(theirs, describe);
  }
  processes_ = std::make_unique<Processes>(std::move(mine), helper_);
}

IsolatedJobs::~IsolatedJobs() {
  kill(helper_, SIGKILL);  // ends the computing process, too
  retried([&] { return waitpid(helper_, nullptr, 0); });
}

JobFactory IsolatedJobs::jobs(const std::string& description, JobFactory make_job) {
  processes_->send_description(description);
  return [this, make_job = std::move(make_job)](std::int64_t task,
                                                std::span<const std::byte> snapshot) -> std::unique_ptr<Job> {
    if (!processes_->have_helper()) return make_job(task, snapshot);
    return std::make_unique<IsolatedJob>(*processes_, make_job(task, {})->row(), snapshot);
  };
}

}  // namespace clog::scheduler

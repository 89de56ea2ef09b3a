#pragma once

#include <sys/types.h>

#include <functional>
#include <memory>
#include <string>

#include "clog/sweep/job.hpp"

namespace clog::scheduler {

/// Jobs in a separate process, so that a crash ends a task and not the sweep: the task is then `failed`, with
/// the signal or exit code as its message, and the next one gets a new process.
///
/// A process serves one task after the other, and keeps its obstacle array, until it crashes. It is forked
/// not by the rank but by a helper that was forked before MPI started, so no computing process has MPI, its
/// threads, its registered memory, or an open file of the sweep. All of them die with the rank.
///
/// A rank waits for none of them: a process that hangs blocks only its own task, and delays a stop by two
/// seconds. If the helper dies, the present task is `failed`, and the rank computes the next ones itself.
/// When memory runs out the kernel kills the computing processes first.
class IsolatedJobs {
 public:
  /// Makes the jobs that a text, such as a config, describes. Called in the helper.
  using Describe = std::function<sweep::JobFactory(const std::string& description)>;

  /// Forks the helper: call this before MPI_Init, while there are no threads. @throws Error if no process can
  /// be started; std::system_error if no socket can be made
  explicit IsolatedJobs(const Describe& describe);
  ~IsolatedJobs();
  IsolatedJobs(const IsolatedJobs&) = delete;
  IsolatedJobs& operator=(const IsolatedJobs&) = delete;

  /// To be called once. At most one of its jobs may exist at a time, and none may outlive this object.
  /// @param make_job  makes the described jobs in this rank: while there is a helper, only for their initial
  /// row
  sweep::JobFactory jobs(const std::string& description, sweep::JobFactory make_job);

 private:
  class Processes;
  class IsolatedJob;

  pid_t helper_ = -1;
  std::unique_ptr<Processes> processes_;
};

}  // namespace clog::scheduler

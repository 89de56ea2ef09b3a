#pragma once

#include <sys/types.h>

#include <functional>
#include <memory>
#include <string>

#include "clog/sweep/job.hpp"

namespace clog::scheduler {

/// Jobs in a separate process, so that a crash ends only a task and not the sweep. The task is then `failed`,
/// its message is the signal or exit code, and the next task gets a new process.
///
/// Such a process computes one task after the other, and keeps its obstacle array, until it crashes. The rank
/// does not fork the process itself. A helper forks it, and this helper was forked before MPI started. So no
/// computing process has MPI, its threads, its registered memory, or an open file of the sweep. The helper
/// and the computing process end with the rank.
///
/// A rank never waits for these processes: a process that hangs blocks only its own task, and delays a stop
/// by two seconds. If the helper dies, the present task is `failed`, and the rank computes further tasks
/// itself. When memory runs out, the kernel kills the computing processes first.
class IsolatedJobs {
 public:
  /// Makes the jobs that a text, such as a config, describes. The helper calls this function.
  using Describe = std::function<sweep::JobFactory(const std::string& description)>;

  /// Forks the helper. Call this before MPI_Init, while there are no threads. @throws Error if no process can
  /// be started; std::system_error if no socket can be made
  explicit IsolatedJobs(const Describe& describe);
  ~IsolatedJobs();
  IsolatedJobs(const IsolatedJobs&) = delete;
  IsolatedJobs& operator=(const IsolatedJobs&) = delete;

  /// Call this once. At most one job of the factory may exist at a time, and no job may outlive this object.
  /// @param make_job  makes the described jobs in this rank. While there is a helper, only the initial row of
  /// these jobs is used.
  sweep::JobFactory jobs(const std::string& description, sweep::JobFactory make_job);

 private:
  class Processes;
  class IsolatedJob;

  pid_t helper_ = -1;
  std::unique_ptr<Processes> processes_;
};

}  // namespace clog::scheduler

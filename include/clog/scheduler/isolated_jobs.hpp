#pragma once

#include <sys/types.h>

#include <functional>
#include <memory>
#include <string>

#include "clog/sweep/job.hpp"

namespace clog::scheduler {

/// Jobs whose work is done by a process of its own, so that a crash ends a task and not the sweep: the task
/// is then `failed`, with the signal or exit code as its message, and the next one gets a new process.
///
/// A process serves one task after the other, and keeps its obstacle array, until it crashes. It is forked
/// not by the rank but by a helper that was forked before MPI began: no process that computes has ever seen
/// MPI, its threads or its registered memory, nor any file of the sweep. All of them die with the rank.
///
/// A rank waits for none of them: a process that hangs costs its own task only, and a stop two seconds more.
/// If the helper dies, the present task is `failed`, and the rank does the work of the next ones itself. When
/// memory runs out the kernel takes the processes that compute first.
class IsolatedJobs {
 public:
  /// Makes the jobs that a text, such as a config, describes. Called in the helper.
  using Describe = std::function<sweep::JobFactory(const std::string& description)>;

  /// Forks the helper: to be called before MPI_Init, while there are no threads.
  /// @throws Error if no process can be started; std::system_error if no socket can be made
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

#pragma once

#include <string>
#include <vector>

namespace clog::results {

/// Mean numbers of busy ranks during one session of a sweep, for intervals of time. All intervals have the
/// same length, which grows with the length of the session.
class Activity {
 public:
  /// @param num_ranks  number of ranks that compute
  explicit Activity(int num_ranks) : num_ranks_(num_ranks) {}

  /// Call these when a rank begins or ends a task.
  /// @param now  time since the session began; must not decrease from call to call [s]
  void started(double now);
  void ended(double now);
  /// Call this when a task starts at its release because its snapshot cannot be used.
  void restarted() { ++num_restarts_; }

  /// One line of JSON. `idle_seconds` is the sum over all ranks. `tail_seconds` is the part of this sum after
  /// the last start of a task: from then on, ranks without work wait for the last tasks to end.
  /// @param start_time  time at which the session began, as text
  std::string line(const std::string& start_time, double now) const;

 private:
  int num_ranks_;
  int num_busy_ = 0;
  int num_restarts_ = 0;
  double interval_ = 1;       // length of an interval [s]
  std::vector<double> busy_;  // busy time of all ranks in each interval [s]
  double last_ = 0;
  double last_start_ = 0;
  double busy_seconds_ = 0;
  double tail_busy_seconds_ = 0;  // busy time since the last start of a task [s]

  void count_until(double now);
  void lengthen();
};

/// Adds a session's line to the lines of earlier sessions, and drops the oldest lines if there are too many.
std::string with_session(const std::string& lines, const std::string& line);

}  // namespace clog::results

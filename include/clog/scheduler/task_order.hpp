#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

namespace clog::scheduler {

/// Chooses the next task: the task that is expected to run longest. Long tasks start first, so that ranks do
/// not idle at the end while a long task finishes.
///
/// The tasks of a group differ only in their seed, and are handed out in order. A group's expected run time
/// is results::SetTimes::mean_seconds(). Tasks of a group without an ended task are expected to run longer
/// than all others; if there are several such groups, the group with the fewest started tasks is next.
class TaskOrder {
 public:
  using GroupOf = std::function<std::int64_t(std::int64_t task)>;

  /// No tasks yet.
  explicit TaskOrder(GroupOf group_of) : number_of_group_(std::move(group_of)) {}
  /// Adds the tasks of a round, possibly of new groups.
  void add(const std::vector<std::int64_t>& tasks);

  bool empty() const { return num_left_ == 0; }
  /// Hands out a task; there must be one. The cost is proportional to the number of running groups.
  /// @param now  time since a fixed moment, the same moment in all calls [s]
  std::int64_t take(double now);
  void ended(std::int64_t task, double now);
  /// Records that a task that had ended has started again.
  void begun_again(std::int64_t task, double now);

 private:
  /// Priority of a group; the group with the smallest value is next. It contains, in this order: minus the
  /// expected run time, the number of tasks handed out, the number of the group.
  using Turn = std::tuple<double, std::int64_t, std::size_t>;
  struct Group {
    std::vector<std::int64_t> tasks;
    std::size_t next = 0;  // index of the next task
    std::int64_t num_taken = 0;
    std::int64_t num_ended = 0;
    double time_ended = 0;     // sum of the run times of the tasks that ended [s]
    double start_running = 0;  // sum of the starts of the tasks that run
    Turn turn;                 // constant in time while no task of the group runs

    bool is_waiting() const { return next < tasks.size(); }
  };
  GroupOf number_of_group_;
  std::int64_t num_left_ = 0;
  std::vector<Group> groups_;
  // Groups with waiting tasks: resting_ contains the groups without a running task, running_ the numbers of
  // the groups with a running task.
  std::set<Turn> resting_;
  std::set<std::size_t> running_;
  std::unordered_map<std::int64_t, double> running_since_;  // start of each running task, by task

  std::size_t number_of(std::int64_t task);
  void begin(std::size_t number, std::int64_t task, double now);
  void leave(std::size_t number);
  void enter(std::size_t number);
  Turn turn_of(std::size_t number, double now) const;
};

}  // namespace clog::scheduler

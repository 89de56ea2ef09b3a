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

/// Which task to hand out next: the one expected to run longest, so that no long one is left for the end,
/// when ranks without work would wait for it.
///
/// The tasks of a group differ in their seed only, and are handed out in order. A group's expected run time
/// is the mean of an exponential distribution fitted to its finished and, as censored, its running tasks: all
/// their time over the number that ended. A group of which none has ended is expected to be longer than any
/// other; among those the one with fewest tasks handed out is next.
class TaskOrder {
 public:
  using GroupOf = std::function<std::int64_t(std::int64_t task)>;

  /// No tasks yet.
  explicit TaskOrder(GroupOf group_of) : number_of_group_(std::move(group_of)) {}
  /// Tasks of a round; maybe of new groups.
  void add(const std::vector<std::int64_t>& tasks);

  bool empty() const { return num_left_ == 0; }
  /// Hands out a task; there must be one. Costs a look at every group that runs.
  /// @param now  time [s], from any moment on, the same in all calls
  std::int64_t take(double now);
  void ended(std::int64_t task, double now);
  /// A task that ended before starts again.
  void begun_again(std::int64_t task, double now);

 private:
  /// Less: it is handed out earlier. The expected run time with a minus, tasks handed out, number of the
  /// group.
  using Turn = std::tuple<double, std::int64_t, std::size_t>;
  struct Group {
    std::vector<std::int64_t> tasks;
    std::size_t next = 0;  // of the tasks
    std::int64_t num_taken = 0;
    std::int64_t num_ended = 0;
    double time_ended = 0;     // run times of the tasks that ended [s]
    double start_running = 0;  // sum of the starts of those that run
    Turn turn;                 // while none runs it does not depend on the time

    bool is_waiting() const { return next < tasks.size(); }
  };
  GroupOf number_of_group_;
  std::int64_t num_left_ = 0;
  std::vector<Group> groups_;
  // Groups with tasks that wait: those of which none runs, and the numbers of the others.
  std::set<Turn> resting_;
  std::set<std::size_t> running_;
  std::unordered_map<std::int64_t, double> running_since_;  // by task

  std::size_t number_of(std::int64_t task);
  void begin(std::size_t number, std::int64_t task, double now);
  void leave(std::size_t number);
  void enter(std::size_t number);
  Turn turn_of(std::size_t number, double now) const;
};

}  // namespace clog::scheduler

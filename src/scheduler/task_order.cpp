#include "clog/scheduler/task_order.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "clog/results/time_left.hpp"

namespace clog::scheduler {

void TaskOrder::add(const std::vector<std::int64_t>& tasks) {
  num_left_ += static_cast<std::int64_t>(tasks.size());
  for (const std::int64_t task : tasks) {
    const std::size_t number = number_of(task);
    const bool was_waiting = groups_[number].is_waiting();
    groups_[number].tasks.push_back(task);
    if (!was_waiting) enter(number);
  }
}

std::size_t TaskOrder::number_of(std::int64_t task) {
  const auto number = static_cast<std::size_t>(number_of_group_(task));
  if (number >= groups_.size()) groups_.resize(number + 1);
  return number;
}

void TaskOrder::leave(std::size_t number) {
  resting_.erase(groups_[number].turn);
  running_.erase(number);
}

void TaskOrder::enter(std::size_t number) {
  Group& group = groups_[number];
  if (!group.is_waiting()) return;
  if (group.num_taken > group.num_ended)
    running_.insert(number);
  else
    resting_.insert(group.turn = turn_of(number, 0));
}

void TaskOrder::begin(std::size_t number, std::int64_t task, double now) {
  leave(number);
  Group& group = groups_[number];
  ++group.num_taken;
  group.start_running += now;
  running_since_[task] = now;
  enter(number);
}

void TaskOrder::begun_again(std::int64_t task, double now) { begin(number_of(task), task, now); }

TaskOrder::Turn TaskOrder::turn_of(std::size_t number, double now) const {
  const Group& group = groups_[number];
  const std::int64_t num_running = group.num_taken - group.num_ended;
  const double time_running = static_cast<double>(num_running) * now - group.start_running;
  const results::SetTimes times = {.num_finished = group.num_ended,
                                   .num_running = num_running,
                                   .seconds = group.time_ended + time_running};
  return {-times.mean_seconds(), group.num_taken, number};
}

std::int64_t TaskOrder::take(double now) {
  assert(!empty());
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Turn next = resting_.empty() ? Turn{infinity, 0, 0} : *resting_.begin();
  for (const std::size_t number : running_) next = std::min(next, turn_of(number, now));
  const std::size_t number = std::get<std::size_t>(next);
  Group& group = groups_[number];
  leave(number);
  const std::int64_t task = group.tasks[group.next++];
  --num_left_;
  begin(number, task, now);
  return task;
}

void TaskOrder::ended(std::int64_t task, double now) {
  const std::size_t number = number_of(task);
  leave(number);
  Group& group = groups_[number];
  const auto running = running_since_.find(task);
  assert(running != running_since_.end());
  ++group.num_ended;
  group.time_ended += now - running->second;
  group.start_running -= running->second;
  running_since_.erase(running);
  enter(number);
}

}  // namespace clog::scheduler

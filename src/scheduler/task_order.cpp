#include "clog/scheduler/task_order.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>

namespace clog::scheduler {

void TaskOrder::add(const std::vector<std::int64_t>& tasks) {
  num_left_ += static_cast<std::int64_t>(tasks.size());
  for (const std::int64_t task : tasks) group_of(task).waiting.push_back(task);
}

TaskOrder::Group& TaskOrder::group_of(std::int64_t task) {
  const auto number = static_cast<std::size_t>(number_of_group_(task));
  if (number >= groups_.size()) groups_.resize(number + 1);
  return groups_[number];
}

void TaskOrder::begin(Group& group, std::int64_t task, double now) {
  ++group.num_taken;
  group.start_running += now;
  running_since_[task] = now;
}

void TaskOrder::begun_again(std::int64_t task, double now) { begin(group_of(task), task, now); }

double TaskOrder::expected_time(const Group& group, double now) const {
  if (group.num_ended == 0) return std::numeric_limits<double>::infinity();
  const auto num_running = static_cast<double>(group.num_taken - group.num_ended);
  const double time_running = num_running * now - group.start_running;
  return (group.time_ended + time_running) / static_cast<double>(group.num_ended);
}

std::int64_t TaskOrder::take(double now) {
  assert(!empty());
  Group* next = nullptr;
  double longest = 0;
  for (Group& group : groups_) {
    if (group.waiting.empty()) continue;
    const double expected = expected_time(group, now);
    if (!next || expected > longest || (expected == longest && group.num_taken < next->num_taken)) {
      next = &group;
      longest = expected;
    }
  }
  assert(next);  // num_left_ counts those that wait
  const std::int64_t task = next->waiting.front();
  next->waiting.pop_front();
  --num_left_;
  begin(*next, task, now);
  return task;
}

void TaskOrder::ended(std::int64_t task, double now) {
  Group& group = group_of(task);
  const auto running = running_since_.find(task);
  assert(running != running_since_.end());
  ++group.num_ended;
  group.time_ended += now - running->second;
  group.start_running -= running->second;
  running_since_.erase(running);
}

}  // namespace clog::scheduler

#include "clog/parallel/task_order.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace clog::parallel {

TaskOrder::TaskOrder(std::int64_t num_tasks, std::int64_t num_groups) : num_left_(num_tasks) {
  assert(num_groups > 0);
  groups_.resize(std::min(num_groups, num_tasks));
  for (std::int64_t group = 0; group < static_cast<std::int64_t>(groups_.size()); ++group)
    groups_[group].num_tasks = (num_tasks - group + num_groups - 1) / num_groups;
}

double TaskOrder::expected_time(const Group& group, double now) const {
  if (group.num_ended == 0) return std::numeric_limits<double>::infinity();
  const auto num_running = static_cast<double>(group.num_taken - group.num_ended);
  const double time_running = num_running * now - group.start_running;
  return (group.time_ended + time_running) / static_cast<double>(group.num_ended);
}

std::int64_t TaskOrder::take(double now) {
  assert(!empty());
  const Group* next = nullptr;
  double longest = 0;
  for (const Group& group : groups_) {
    if (group.num_taken == group.num_tasks) continue;
    const double expected = expected_time(group, now);
    if (!next || expected > longest || (expected == longest && group.num_taken < next->num_taken)) {
      next = &group;
      longest = expected;
    }
  }
  const std::int64_t index = next - groups_.data();
  Group& group = groups_[index];
  const std::int64_t task = group.num_taken * static_cast<std::int64_t>(groups_.size()) + index;
  ++group.num_taken;
  --num_left_;
  group.start_running += now;
  running_since_[task] = now;
  return task;
}

void TaskOrder::ended(std::int64_t task, double now) {
  Group& group = groups_[task % static_cast<std::int64_t>(groups_.size())];
  const auto running = running_since_.find(task);
  assert(running != running_since_.end());
  ++group.num_ended;
  group.time_ended += now - running->second;
  group.start_running -= running->second;
  running_since_.erase(running);
}

}  // namespace clog::parallel

#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "clog/scheduler/task_order.hpp"

namespace clog::scheduler {

/// An order of tasks. The task with number i belongs to group i % num_groups.
inline TaskOrder order_of(const std::vector<std::int64_t>& tasks, std::int64_t num_groups = 1) {
  TaskOrder order([num_groups](std::int64_t task) { return task % num_groups; });
  order.add(tasks);
  return order;
}
/// An order of the tasks 0, 1, ... num_tasks - 1.
inline TaskOrder order_of(std::int64_t num_tasks, std::int64_t num_groups = 1) {
  std::vector<std::int64_t> tasks(num_tasks);
  std::iota(tasks.begin(), tasks.end(), std::int64_t{0});
  return order_of(tasks, num_groups);
}

}  // namespace clog::scheduler

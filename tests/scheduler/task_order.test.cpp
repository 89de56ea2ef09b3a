#include "clog/scheduler/task_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "order_of.hpp"

namespace clog::scheduler {
namespace {

TEST(TaskOrder, BeginsWithOneTaskOfEveryGroup) {
  TaskOrder tasks = order_of(12, 4);
  for (int task = 0; task < 12; ++task) EXPECT_EQ(tasks.take(0), task);
  EXPECT_TRUE(tasks.empty());
}

TEST(TaskOrder, HandsOutEveryTaskOnceWhateverTheirLengths) {
  for (const int num_groups : {1, 3, 7, 20, 30}) {
    TaskOrder tasks = order_of(20, num_groups);
    std::set<std::int64_t> taken;
    for (double now = 0; !tasks.empty(); now += 1) {
      const std::int64_t task = tasks.take(now);
      EXPECT_TRUE(task >= 0 && task < 20);
      EXPECT_TRUE(taken.insert(task).second) << task;
      if (task % 2 == 0) tasks.ended(task, now + static_cast<double>(task * 7 % 5));
    }
    EXPECT_EQ(taken.size(), 20u) << num_groups;
  }
}

TEST(TaskOrder, GoesOnWithTheGroupThatRanLongest) {
  TaskOrder tasks = order_of(9, 3);
  for (int group = 0; group < 3; ++group) tasks.take(0);
  tasks.ended(0, 2);
  tasks.ended(1, 5);
  tasks.ended(2, 3);
  EXPECT_EQ(tasks.take(6), 4);
  tasks.ended(4, 6.5);  // now the mean of group 1 is 2.75
  EXPECT_EQ(tasks.take(7), 5);
}

TEST(TaskOrder, RemembersRunTimesInTheNextRound) {
  TaskOrder tasks = order_of(3, 3);
  for (const std::int64_t task : {0, 1, 2}) EXPECT_EQ(tasks.take(0), task);
  tasks.ended(0, 1);
  tasks.ended(1, 3);
  tasks.ended(2, 2);
  EXPECT_TRUE(tasks.empty());
  tasks.add({3, 4, 5});
  EXPECT_EQ(tasks.take(3), 4) << "its group ran longest";
  EXPECT_EQ(tasks.take(3), 5);
}

TEST(TaskOrder, ExpectsAGroupWithoutResultsToBeLong) {
  TaskOrder tasks = order_of(6, 3);
  for (int group = 0; group < 3; ++group) tasks.take(0);
  tasks.ended(0, 2);
  tasks.ended(2, 5);
  EXPECT_EQ(tasks.take(6), 4);
  EXPECT_EQ(tasks.take(6), 5);
  EXPECT_EQ(tasks.take(6), 3);
}

TEST(TaskOrder, HandsOutTheLongestOfAllGroups) {
  constexpr int num_groups = 13, num_tasks = 400;
  struct Known {
    int num_left = 0, num_ended = 0;
    double time_ended = 0;
    std::map<std::int64_t, double> starts;  // start times of the running tasks
  };
  std::vector<Known> known(num_groups);
  for (int task = 0; task < num_tasks; ++task) ++known[task % num_groups].num_left;
  TaskOrder tasks = order_of(num_tasks, num_groups);
  std::mt19937 random(7);
  double now = 0;
  for (int i = 0; i < num_tasks; ++i, now += 0.125) {
    // The group with the longest time per ended task comes first. The times of running tasks count, too.
    // Among equal groups, the group with the fewest begun tasks comes first.
    const auto turn = [&](const Known& group) {
      double time = group.time_ended;
      for (const auto& [task, start] : group.starts) time += now - start;
      const double expected = group.num_ended == 0 ? std::numeric_limits<double>::infinity()
                                                   : time / static_cast<double>(group.num_ended);
      return std::make_tuple(group.num_left == 0, -expected, group.num_ended + std::ssize(group.starts));
    };
    const auto next = std::ranges::min_element(known, {}, turn);
    const std::int64_t task = tasks.take(now);
    ASSERT_EQ(task % num_groups, std::distance(known.begin(), next)) << i;
    --next->num_left;
    next->starts[task] = now;
    while (random() % 5 < 2) {
      Known& group = known[random() % num_groups];
      if (group.starts.empty()) continue;
      const auto [ended, start] = *group.starts.begin();
      tasks.ended(ended, now);
      group.time_ended += now - start;
      ++group.num_ended;
      group.starts.erase(ended);
    }
  }
}

TEST(TaskOrder, CountsTheTimeOfRunningTasks) {
  TaskOrder tasks = order_of(8, 2);
  for (int task = 0; task < 4; ++task) tasks.take(0);
  tasks.ended(0, 1);
  tasks.ended(1, 4);
  EXPECT_EQ(tasks.take(4), 5) << "both have run for 4 seconds more: 1 + 4 against 4 + 4";
  tasks.ended(3, 4);  // group 1 took 8 seconds for two tasks, and another of its tasks has just begun
  EXPECT_EQ(tasks.take(4), 4) << "5 seconds, one task ended, against 8 and two";
}

}  // namespace
}  // namespace clog::scheduler

#include "core/polygon/step/wall_plan.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "core/polygon/step/wall_windows.hpp"

namespace clog {
namespace {

constexpr int size = kernel::edges_per_group;

using Item = WallContacts::Item;
using EdgeAtCircle = std::pair<double, int>;  // the circle by its x

std::set<EdgeAtCircle> edges_of(const std::vector<Item>& items) {
  std::set<EdgeAtCircle> edges;
  for (const Item& item : items)
    for (int b = 0; b < size; ++b)
      if (item.edges >> b & 1) edges.insert({item.x, item.group * size + b});
  return edges;
}

/// That every edge of the items is in one window, and what else a plan promises.
void check(int num_vertices, const std::vector<Item>& items, const kernel::WallWindows& plan) {
  std::multiset<EdgeAtCircle> planned;
  std::map<int, int> own;  // windows of an edge
  std::set<int> pushed;    // groups of vertices
  const int num_groups = (num_vertices + size - 1) / size;
  for (int k = 0; k < plan.num_all; ++k) {
    const kernel::WallWindow& window = plan.all[k];
    ASSERT_NE(window.edges, 0);
    ASSERT_GE(window.first, 0);
    ASSERT_LE(window.first + size, num_groups * size) << "nothing can be read behind the last group";
    for (int b = 0; b < size; ++b) {
      if (!(window.edges >> b & 1)) continue;
      const int edge = window.first + b;
      planned.insert({window.x, edge});
      if (k < plan.num_own) {
        EXPECT_EQ(++own[edge], 1);
      } else {
        EXPECT_EQ(own[edge], 1) << "what shares an edge comes after whose it is";
      }
      for (int vertex = edge - 1; vertex <= edge + 2; ++vertex) pushed.insert((vertex + size) / size - 1);
    }
  }
  const std::set<EdgeAtCircle> wanted = edges_of(items);
  EXPECT_EQ(planned, std::multiset<EdgeAtCircle>(wanted.begin(), wanted.end()));
  const std::set<int> groups(plan.groups, plan.groups + plan.num_groups);
  EXPECT_EQ(groups.size(), static_cast<std::size_t>(plan.num_groups));
  for (const int group : pushed) EXPECT_TRUE(groups.contains(group)) << group;
  const bool is_full = num_vertices % size == 0;
  const bool wraps = pushed.contains(-1) || pushed.contains(is_full ? num_groups : num_groups - 1);
  if (wraps) {
    EXPECT_TRUE(groups.contains(0) && groups.contains(num_groups - 1)) << "the ends push each other";
  }
}

TEST(WallPlan, HoldsEveryEdgeOnceAndSharedOnesLast) {
  std::mt19937 engine(1);
  for (const int n : {16, 24, 30, 101, 256}) {
    const int num_groups = (n + size - 1) / size;
    WallPlan plan(n);
    for (int round = 0; round < 50; ++round) {
      std::vector<Item> items;
      for (int circle = 0; circle < 6; ++circle)
        for (int group = 0; group < num_groups; ++group) {
          const auto some = engine(), others = engine();
          const auto edges = static_cast<std::uint8_t>(some & others);
          const bool is_last = group == num_groups - 1 && n % size != 0;
          const auto there = static_cast<std::uint8_t>(is_last ? edges & ((1 << n % size) - 1) : edges);
          if (there != 0 && engine() % 3 == 0) items.push_back({circle + 1.0, 0, 0.15, group, there});
        }
      plan.make(items);
      check(n, items, plan.windows());
    }
    plan.make({});
    EXPECT_EQ(plan.windows().num_all, 0);
    EXPECT_EQ(plan.windows().num_groups, 0);
  }
}

TEST(WallPlan, BeginsAWindowWhereACircleBegins) {
  WallPlan plan(64);
  plan.make({{1, 0, 0.15, 2, 0b11100000}, {1, 0, 0.15, 3, 0b00011111}});
  ASSERT_EQ(plan.windows().num_all, 1) << "eight edges of two groups are one window";
  EXPECT_EQ(plan.windows().all[0].first, 21);
  EXPECT_EQ(plan.windows().all[0].edges, 0xff);
}

TEST(WallWindows, OfTheSameCircleTwiceAreListedTwice) {
  const Item one{1, 2, 0.3, 0, 0x81}, other{1, 2, 0.3, 3, 0x01};
  const std::vector<Item> once = {one, other}, twice = {one, other, one, other};
  std::vector<kernel::WallWindow> windows;
  list_windows(once, 8, windows);
  const std::size_t num_windows = windows.size();
  list_windows(twice, 8, windows);
  EXPECT_EQ(windows.size(), 2 * num_windows);
}

}  // namespace
}  // namespace clog

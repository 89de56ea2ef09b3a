#include "wall_plan.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

#include "wall_windows.hpp"

namespace clog {
namespace {

constexpr int num_arrays = kernel::num_window_push_arrays;

}  // namespace

WallPlan::WallPlan(int num_vertices)
    : num_groups_((num_vertices + kernel::edges_per_group - 1) / kernel::edges_per_group) {
  // The step also reads the groups just before and after the contour, and the groups next to these.
  constexpr int before = 2, behind = 2;
  windows_.pushes.stride = std::ptrdiff_t{before + num_groups_ + behind} * kernel::edges_per_group;
  memory_ = aligned_zeros(num_arrays * static_cast<std::size_t>(windows_.pushes.stride));
  windows_.pushes.first = memory_.get() + std::ptrdiff_t{before} * kernel::edges_per_group;
}

void WallPlan::make(const std::vector<WallContacts::Item>& near) {
  clear_pushes();
  all_.clear();
  sharing_.clear();
  is_taken_.assign(static_cast<std::size_t>(num_groups_) * kernel::edges_per_group, 0);
  list_windows(near, num_groups_, listed_);
  for (const kernel::WallWindow& window : listed_) add(window);
  windows_.num_own = static_cast<int>(all_.size());
  all_.insert(all_.end(), sharing_.begin(), sharing_.end());
  windows_.all = all_.data();
  windows_.num_all = static_cast<int>(all_.size());
  find_groups();
}

void WallPlan::clear_pushes() {
  for (const kernel::WallWindow& window : all_)
    for (int array = 0; array < num_arrays; ++array)
      std::fill_n(windows_.pushes.first + array * windows_.pushes.stride + window.first,
                  kernel::edges_per_group, 0.0);
}

void WallPlan::add(const kernel::WallWindow& window) {
  unsigned shared = 0;
  for (unsigned edges = window.edges; edges != 0; edges &= edges - 1) {
    const int edge = std::countr_zero(edges);
    std::uint8_t& is_taken =
        is_taken_[static_cast<std::size_t>(window.first) + static_cast<std::size_t>(edge)];
    if (is_taken != 0) shared |= 1U << edge;
    is_taken = 1;
  }
  const auto add_edges = [&](unsigned edges, std::vector<kernel::WallWindow>& windows) {
    if (edges == 0) return;
    windows.push_back(window);
    windows.back().edges = static_cast<std::uint8_t>(edges);
  };
  add_edges(window.edges & ~shared, all_);
  add_edges(shared, sharing_);
}

void WallPlan::find_groups() {
  is_pushed_.assign(static_cast<std::size_t>(num_groups_) + 2, 0);
  for (const kernel::WallWindow& window : all_) mark_pushed_groups(window, is_pushed_);
  // Forces beyond one end of the contour are added to the groups at the other end.
  const bool wraps = is_pushed_.front() != 0 || is_pushed_.back() != 0 || is_pushed_[num_groups_] != 0;
  if (wraps) is_pushed_[1] = is_pushed_[num_groups_] = 1;
  groups_.clear();
  for (int group = -1; group <= num_groups_; ++group)
    if (is_pushed_[group + 1] != 0) groups_.push_back(group);
  windows_.groups = groups_.data();
  windows_.num_groups = static_cast<int>(groups_.size());
}

}  // namespace clog

#include "wall_plan.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace clog {
namespace {

constexpr int size = kernel::edges_per_group;
constexpr int num_arrays = 6;  // of kernel::WallWindows

bool is_same_circle(const kernel::WallWindow& window, const WallContacts::Item& item) {
  return window.x == item.x && window.y == item.y && window.reach == item.reach;
}

}  // namespace

WallPlan::WallPlan(int num_vertices) : num_groups_((num_vertices + size - 1) / size) {
  // Groups before and behind the contour, and those next to them, are read.
  constexpr int before = 2, behind = 2;
  windows_.stride = std::ptrdiff_t{before + num_groups_ + behind} * size;
  const std::size_t total = num_arrays * static_cast<std::size_t>(windows_.stride);
  memory_ = hwy::AllocateAligned<double>(total);
  std::fill_n(memory_.get(), total, 0.0);
  windows_.pushes = memory_.get() + std::ptrdiff_t{before} * size;
}

void WallPlan::make(const std::vector<WallContacts::Item>& near) {
  clear_pushes();
  all_.clear();
  sharing_.clear();
  is_taken_.assign(static_cast<std::size_t>(num_groups_) * size, 0);
  kernel::WallWindow window{};
  for (const WallContacts::Item& item : near) {
    const int begin = item.group * size;
    for (unsigned edges = item.edges; edges != 0;) {
      const int edge = begin + std::countr_zero(edges);
      if (!is_same_circle(window, item) || edge - window.first >= size) {
        add(window);
        // Nothing can be read behind the last group.
        window = {item.x, item.y, item.reach, std::min(edge, (num_groups_ - 1) * size), 0};
      }
      const int ahead = begin - window.first;
      const unsigned inside = (ahead >= 0 ? edges << ahead : edges >> -ahead) & 0xffU;
      window.edges |= static_cast<std::uint8_t>(inside);
      edges &= ~(ahead >= 0 ? inside >> ahead : inside << -ahead);
    }
  }
  add(window);
  windows_.num_own = static_cast<int>(all_.size());
  all_.insert(all_.end(), sharing_.begin(), sharing_.end());
  windows_.all = all_.data();
  windows_.num_all = static_cast<int>(all_.size());
  find_groups();
}

void WallPlan::clear_pushes() {
  for (const kernel::WallWindow& window : all_)
    for (int array = 0; array < num_arrays; ++array)
      std::fill_n(windows_.pushes + array * windows_.stride + window.first, size, 0.0);
}

void WallPlan::add(const kernel::WallWindow& window) {
  unsigned shared = 0;
  for (unsigned edges = window.edges; edges != 0; edges &= edges - 1) {
    const int edge = std::countr_zero(edges);
    std::uint8_t& is_taken = is_taken_[static_cast<std::size_t>(window.first + edge)];
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

/// An edge pushes the vertex before it and the two behind it as well.
void WallPlan::find_groups() {
  is_pushed_.assign(static_cast<std::size_t>(num_groups_) + 2, 0);
  for (const kernel::WallWindow& window : all_) {
    const auto first = is_pushed_.begin() + (window.first - 1 + size) / size;
    std::fill(first, is_pushed_.begin() + (window.first + size + 1) / size + 2, 1);
  }
  // Of both ends what they push of the other one is added to that.
  const bool wraps = is_pushed_.front() != 0 || is_pushed_.back() != 0 || is_pushed_[num_groups_] != 0;
  if (wraps) is_pushed_[1] = is_pushed_[num_groups_] = 1;
  groups_.clear();
  for (int group = -1; group <= num_groups_; ++group)
    if (is_pushed_[group + 1] != 0) groups_.push_back(group);
  windows_.groups = groups_.data();
  windows_.num_groups = static_cast<int>(groups_.size());
}

}  // namespace clog

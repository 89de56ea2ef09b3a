#include "wall_hold.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "wall_windows.hpp"

namespace clog {
namespace {

// The step also reads the groups just before and after the contour, and the groups next to these.
constexpr int before = 2, behind = 2;

}  // namespace

WallHold::WallHold(int num_vertices, double range)
    : num_vertices_(num_vertices),
      num_groups_((num_vertices + kernel::edges_per_group - 1) / kernel::edges_per_group),
      range_(range) {}

double WallHold::make(const std::vector<WallContacts::Item>& near, DropletState& droplet) {
  hand_back(droplet);
  clear_pushes();
  list_windows(near, num_groups_, windows_);
  find_circles();
  groups_.clear();
  for (kernel::HoldingCircle& circle : all_) add_groups(circle);
  arrange_memory();
  double lost = 0;
  for (const WallAnchor& anchor : droplet.anchors)
    if (!take(anchor)) lost += anchor.slip * anchor.slip / 2;
  droplet.anchors.clear();
  has_anchors_ = true;
  return lost;
}

void WallHold::find_circles() {
  all_.clear();
  for (int k = 0; k < static_cast<int>(windows_.size()); ++k) {
    const kernel::WallWindow& window = windows_[static_cast<std::size_t>(k)];
    const double radius = window.reach - range_;
    if (all_.empty() || all_.back().x != window.x || all_.back().y != window.y ||
        all_.back().radius != radius)
      all_.push_back({window.x, window.y, radius, window.layer, k, k, 0, 0, false, {}});
    all_.back().end_window = k + 1;
  }
}

void WallHold::add_groups(kernel::HoldingCircle& circle) {
  is_pushed_.assign(static_cast<std::size_t>(num_groups_) + 2, 0);
  circle.wraps = false;
  for (int k = circle.first_window; k < circle.end_window; ++k) {
    const kernel::WallWindow& window = windows_[static_cast<std::size_t>(k)];
    mark_pushed_groups(window, is_pushed_);
    const int last = window.first + static_cast<int>(std::bit_width(window.edges)) - 1;
    circle.wraps |= (window.first == 0 && (window.edges & 1) != 0) || last + 2 >= num_vertices_;
  }
  // The arrays of the step repeat the contour beyond both ends. Forces on repeated vertices are added to the
  // original vertices at the other end, so the groups at both ends count as pushed.
  if (circle.wraps)
    is_pushed_.front() = is_pushed_[1] = is_pushed_[static_cast<std::size_t>(num_groups_)] =
        is_pushed_.back() = 1;
  circle.first_group = static_cast<int>(groups_.size());
  for (std::size_t k = 0; k < is_pushed_.size(); ++k)
    if (is_pushed_[k] != 0) groups_.push_back(static_cast<int>(k) - 1);
  circle.end_group = static_cast<int>(groups_.size());
}

void WallHold::Memory::make_room(std::size_t needed, std::size_t num_zeroed) {
  if (capacity < needed) {
    capacity = 2 * needed;
    numbers = aligned_zeros(capacity);
  } else {
    std::fill_n(numbers.get(), num_zeroed, 0.0);
  }
}

/// Zeroes the forces that windows stored for their circles.
void WallHold::clear_pushes() {
  for (const kernel::HoldingCircle& circle : all_)
    for (int k = circle.first_window; k < circle.end_window; ++k)
      for (int array = 0; array < kernel::num_window_push_arrays; ++array)
        std::fill_n(
            circle.pushes.first + array * circle.pushes.stride + windows_[static_cast<std::size_t>(k)].first,
            kernel::edges_per_group, 0.0);
}

/// The memory consists of arrays of equal length, each for the whole contour. The first three arrays are for
/// all circles together; the arrays of each circle follow.
void WallHold::arrange_memory() {
  const std::size_t stride =
      (static_cast<std::size_t>(num_groups_) + before + behind) * kernel::edges_per_group;
  constexpr std::size_t num_common = 3;
  const std::size_t needed = (num_common + all_.size() * kernel::num_window_push_arrays) * stride;
  memory_.make_room(needed, num_common * stride);
  double* next = memory_.numbers.get() + std::ptrdiff_t{before} * kernel::edges_per_group;
  for (kernel::ContourArray* array : {&circles_.push.x, &circles_.push.y, &circles_.wetted}) {
    array->first = next;
    next += stride;
  }
  for (kernel::HoldingCircle& circle : all_) {
    circle.pushes = {.first = next, .stride = static_cast<std::ptrdiff_t>(stride)};
    next += kernel::num_window_push_arrays * stride;
  }
  arrange_anchors();
  holds_.assign(groups_.size(), 0);
  circles_.all = all_.data();
  circles_.num = all_.size();
  circles_.windows = windows_.data();
  circles_.groups = groups_.data();
  circles_.holds = holds_.data();
}

void WallHold::arrange_anchors() {
  const std::size_t num_entries = groups_.size() * kernel::edges_per_group;
  constexpr std::size_t num_arrays = 3;
  anchors_.make_room(num_arrays * num_entries, num_arrays * num_entries);
  double* next = anchors_.numbers.get();
  for (double** array : {&circles_.anchor_x, &circles_.anchor_y, &circles_.slip}) {
    *array = next;
    next += num_entries;
  }
}

/// Returns whether one of the circles can hold the anchor.
bool WallHold::take(const WallAnchor& anchor) {
  assert(anchor.holder >= 0 && anchor.holder < num_vertices_);
  const auto vertex = static_cast<int>(anchor.holder);
  for (const kernel::HoldingCircle& circle : all_) {
    if (!anchor.wall.is({.x = circle.x, .y = circle.y, .radius = circle.radius})) continue;
    for (int k = circle.first_group; k < circle.end_group; ++k) {
      if (groups_[static_cast<std::size_t>(k)] != vertex / kernel::edges_per_group) continue;
      const std::ptrdiff_t entry =
          std::ptrdiff_t{k} * kernel::edges_per_group + vertex % kernel::edges_per_group;
      circles_.anchor_x[entry] = anchor.x;
      circles_.anchor_y[entry] = anchor.y;
      circles_.slip[entry] = anchor.slip;
      circles_.holds[k] |= static_cast<std::uint8_t>(1U << vertex % kernel::edges_per_group);
      return true;
    }
  }
  return false;
}

void WallHold::hand_back(DropletState& droplet) const {
  if (!has_anchors_) return;
  droplet.anchors.clear();
  for (const kernel::HoldingCircle& circle : all_)
    for (int k = circle.first_group; k < circle.end_group; ++k)
      for (unsigned held = circles_.holds[k]; held != 0; held &= held - 1) {
        const int lane = std::countr_zero(held);
        const std::ptrdiff_t entry = std::ptrdiff_t{k} * kernel::edges_per_group + lane;
        droplet.anchors.push_back(
            {.holder = Eigen::Index{groups_[static_cast<std::size_t>(k)]} * kernel::edges_per_group + lane,
             .wall = {.x = circle.x, .y = circle.y, .radius = circle.radius},
             .x = circles_.anchor_x[entry],
             .y = circles_.anchor_y[entry],
             .slip = circles_.slip[entry]});
      }
}

}  // namespace clog

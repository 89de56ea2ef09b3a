#pragma once

#include <cstdint>
#include <vector>

#include "clog/core/polygon/contact/wall_contacts.hpp"
#include "dp_step_kernel.hpp"

namespace clog {

/// Lists windows. A window is a circle and edges_per_group consecutive edges. It begins at the first edge
/// that may touch the circle, so that no lane is wasted on edges before this edge. Every edge of an item is
/// in exactly one window of the item's circle.
/// @param near  circles and edges that may touch, sorted by circle and group
/// @param num_groups  of the contour's edges
void list_windows(const std::vector<WallContacts::Item>& near, int num_groups,
                  std::vector<kernel::WallWindow>& windows);

/// Marks the groups of vertices that a window may push. Edge i leads from vertex i to vertex i + 1; it pushes
/// the vertices i - 1 to i + 2.
/// @param is_pushed  the first entry belongs to the group before the contour
void mark_pushed_groups(const kernel::WallWindow& window, std::vector<std::uint8_t>& is_pushed);

}  // namespace clog

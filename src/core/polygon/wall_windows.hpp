#pragma once

#include <cstdint>
#include <vector>

#include "clog/core/polygon/wall_contacts.hpp"
#include "dp_step_kernel.hpp"

namespace clog {

/// Lists windows of circles, the first edge of which may touch: wherever a contact begins, a whole vector of
/// edges is at work. Every edge of an item is in one window of its circle.
/// @param near  circles and edges that may touch, one circle after another, each with its groups in their
/// order
/// @param num_groups  of the contour's edges
void list_windows(const std::vector<WallContacts::Item>& near, int num_groups,
                  std::vector<kernel::WallWindow>& windows);

/// Marks the groups of vertices that a window may push: an edge pushes the vertex before it and the two
/// behind it as well. @param is_pushed  the first entry is that of the group before the contour
void mark_pushed_groups(const kernel::WallWindow& window, std::vector<std::uint8_t>& is_pushed);

}  // namespace clog

#pragma once

#include <cstdint>
#include <vector>

#include "aligned_memory.hpp"
#include "clog/core/polygon/contact/wall_contacts.hpp"
#include "dp_step_kernel.hpp"

namespace clog {

/// Repulsion of a contour by circles until the next make(). Each window (see list_windows()) stores the
/// forces of its edges on their vertices. Afterwards the forces on each vertex are summed once. An edge that
/// may touch two circles is in two windows; the second window adds its forces to those of the first.
class WallPlan {
 public:
  explicit WallPlan(int num_vertices);
  /// @param near  circles and edges that may touch, sorted by circle and group
  void make(const std::vector<WallContacts::Item>& near);
  /// The result is valid until the next make().
  const kernel::WallWindows& windows() const { return windows_; }

 private:
  int num_groups_;  // number of groups of edges
  hwy::AlignedFreeUniquePtr<double[]> memory_;
  std::vector<kernel::WallWindow> listed_, all_, sharing_;
  std::vector<std::uint8_t> is_taken_;   // edges that a window contains
  std::vector<std::uint8_t> is_pushed_;  // groups of vertices; entry 0 is the group before the contour
  std::vector<int> groups_;
  kernel::WallWindows windows_{};

  void clear_pushes();
  void add(const kernel::WallWindow& window);
  void find_groups();
};

}  // namespace clog

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "aligned_memory.hpp"
#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/polygon/contact/wall_contacts.hpp"
#include "dp_step_kernel.hpp"

namespace clog {

/// The friction anchors of a droplet (see WallFriction) and the circles that may push it, arranged for the
/// step by circle and by groups of vertices. make() moves the anchors from the droplet into this object. The
/// lists are valid until the next make(). hand_back() copies the anchors into the droplet.
class WallHold {
 public:
  /// @param range  distance from a circle's surface at which contact begins [sigma]
  WallHold(int num_vertices, double range);

  /// Moves the droplet's anchors into this object. Anchors that are on none of the circles `near` are lost.
  /// Returns half the sum of the squared slips of the lost anchors [sigma^2].
  /// @param near  possible contacts until the next make(), see list_windows()
  double make(const std::vector<WallContacts::Item>& near, DropletState& droplet);
  /// Copies the anchors into the droplet, if this object has anchors. It has none after forget() and before
  /// the first make().
  void hand_back(DropletState& droplet) const;
  /// Discards the anchors. The next make() takes anchors from its droplet.
  void forget() { has_anchors_ = false; }
  /// The result is valid until the next make(). A step changes the anchors in it.
  const kernel::HoldingCircles& circles() const { return circles_; }

 private:
  int num_vertices_, num_groups_;  // number of vertices, and of groups of edges
  double range_;
  bool has_anchors_ = false;
  struct Memory {
    hwy::AlignedFreeUniquePtr<double[]> numbers;
    std::size_t capacity = 0;
    /// Zeroes the first `num_zeroed` numbers, or all numbers if the memory must grow.
    void make_room(std::size_t needed, std::size_t num_zeroed);
  };
  Memory memory_;   // pushes of circles; zero except where windows_ have stored a push
  Memory anchors_;  // one entry for each vertex of groups_
  std::vector<kernel::WallWindow> windows_;
  std::vector<kernel::HoldingCircle> all_;
  std::vector<int> groups_;  // groups of vertices that each circle may push, circle after circle
  std::vector<std::uint8_t> holds_, is_pushed_;
  kernel::HoldingCircles circles_{};

  void find_circles();
  void add_groups(kernel::HoldingCircle& circle);
  void clear_pushes();
  void arrange_memory();
  void arrange_anchors();
  bool take(const WallAnchor& anchor);
};

}  // namespace clog

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "aligned_memory.hpp"
#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/polygon/contact/wall_contacts.hpp"
#include "dp_step_kernel.hpp"

namespace clog {

/// The friction anchors of a droplet (see WallFriction) and the circles that may push it, arranged by circle
/// and by groups of vertices for the step. make() takes the anchors over from the droplet, and the lists are
/// valid until the next make(); hand_back() copies the anchors into the droplet.
class WallHold {
 public:
  /// Possible contacts of the contour until the next make().
  struct Near {
    const std::vector<WallContacts::Item>& walls;  ///< see list_windows()
    const std::vector<SelfContacts::Item>& self;
    double way;  ///< largest displacement of any vertex until the next make() [sigma]
  };

  /// @param range  distance from a circle's surface at which contact begins [sigma]
  /// @param film_reach  see kernel::WallGrip
  WallHold(int num_vertices, double range, double film_reach);

  /// Takes over the droplet's anchors. Returns half the sum of the squared slips of those anchors that none
  /// of these circles can hold [sigma^2].
  /// @param vertices  positions of the droplet's vertices
  double make(const Near& near, const kernel::ContourPair& vertices, DropletState& droplet);
  /// Copies the anchors into the droplet, if make() was called since forget().
  void hand_back(DropletState& droplet) const;
  /// Discards the anchors: the next make() adopts those of its droplet.
  void forget() { has_anchors_ = false; }
  double film_reach() const { return film_reach_; }  ///< [sigma]
  /// Valid until the next make(). A step changes the anchors in it.
  const kernel::HoldingCircles& circles() const { return circles_; }

 private:
  int num_vertices_, num_groups_;  // number of vertices, and of groups of edges
  double range_, film_reach_;
  bool has_anchors_ = false;
  struct Memory {
    hwy::AlignedFreeUniquePtr<double[]> numbers;
    std::size_t capacity = 0;
    /// Zeroes the first `num_zeroed` numbers, or all if the memory must grow.
    void make_room(std::size_t needed, std::size_t num_zeroed);
  };
  Memory memory_;   // pushes of circles: zero except where windows_ stored some
  Memory anchors_;  // one entry for each vertex of groups_, and each circle
  std::vector<kernel::WallWindow> windows_;
  std::vector<kernel::HoldingCircle> all_;
  std::vector<int> groups_;  // groups of vertices, circle after circle
  std::vector<std::uint8_t> holds_, is_pushed_, touches_;
  std::vector<std::uint8_t> touches_itself_;  // groups of vertices that self-contact may push
  kernel::HoldingCircles circles_{};

  void find_circles();
  void add_groups(kernel::HoldingCircle& circle);
  void find_films(const Near& near);
  void add_film_groups(kernel::HoldingCircle& circle, double reach, const kernel::ContourPair& vertices);
  void clear_pushes();
  void arrange_memory();
  void arrange_anchors();
  bool take(const WallAnchor& anchor);
};

}  // namespace clog

#pragma once

#include <span>
#include <vector>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/polygon/contact/self_contacts.hpp"
#include "clog/core/polygon/contact/wall_touch.hpp"

namespace clog {

/// Vertices that have passed through another part of their droplet's interface, and the force that pushes
/// them back.
///
/// The repulsion of self-contact depends on the distance between a vertex and an edge, on whichever side the
/// vertex is. Both sides are possible: if the outside of the droplet is between the two, there is a film of
/// water, and if the inside is, a thread of oil. So a vertex whose kinetic energy exceeds the barrier
/// k_c d_s^2/2 would pass through the edge and then be pushed onward. To prevent this, a vertex whose path
/// passes through the inside of an edge is recorded (SelfCrossing). It then is at the distance -d from the
/// edge, or from a neighbour of this edge to which it slides, and the edge pushes it back with the force k_c
/// (d_s + d). Until then, other contacts between the vertex or its edges and these edges are muted, because
/// they do not know the side. A crossing has healed when the vertex's path leads back through the edge.
class SelfCrossings {
 public:
  /// What moved the vertices to their present places: these velocities, for this time.
  struct Drift {
    const double *velocity_x, *velocity_y;  ///< [sqrt(sigma g)]
    double time;                            ///< [t0]
  };
  /// Records new crossings and ends those that have healed.
  /// @return whether muted() has changed
  bool follow(const Contour& contour, const Drift& drift, const SelfContacts& contacts, DropletState& state);
  /// Finds the muted contacts of these crossings, and forgets crossings that the contour does not have.
  void renew(const Contour& contour, std::vector<SelfCrossing>& crossings);
  /// Contacts that do not act.
  std::span<const SelfContacts::Pair> muted() const { return muted_; }
  bool is_muted(const SelfContacts::Pair& pair) const;

  /// The force of an edge on a crossed vertex.
  struct Push {
    Eigen::Index vertex, edge;
    Eigen::Array2d force;  ///< on the vertex, in units of the stiffness
    double fraction;  ///< of the reaction; the edge's second vertex takes it, the first one takes the rest
  };
  static Push push_back(const SelfCrossing& crossing, const Contour& contour, const SelfContacts& contacts);
  /// Energy of a crossed vertex, divided by the stiffness [sigma^2].
  static double energy(const SelfCrossing& crossing, const Contour& contour, const SelfContacts& contacts);

 private:
  std::vector<SelfContacts::Pair> muted_;
  std::vector<int> chain_;  // working memory

  void find_chain(const Contour& contour, const SelfCrossing& crossing, int most, bool bends);
  bool heals(const Contour& contour, const Drift& drift, SelfCrossing& crossing);
  bool is_real(const Contour& contour, const SelfCrossing& crossing, const std::vector<SelfCrossing>& all);
};

}  // namespace clog

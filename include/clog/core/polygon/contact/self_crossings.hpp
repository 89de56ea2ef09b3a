#pragma once

#include <vector>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/polygon/contact/crossing_depth.hpp"
#include "clog/core/polygon/contact/self_contacts.hpp"
#include "clog/core/polygon/contact/wall_touch.hpp"

namespace clog {

/// Vertices that have passed through another part of their droplet's interface, and the force that pushes
/// them back.
///
/// The repulsion of self-contact depends on the distance between a vertex and an edge, on whichever side of
/// the edge the vertex is. The vertex may be on either side: the water outside the droplet may separate the
/// vertex from the edge, or the oil inside it. So a vertex with more kinetic energy than the barrier k_c
/// d_s^2/2 would pass through the edge and then be pushed onward. To prevent this, a vertex is recorded
/// (SelfCrossing) when its path passes through the inside of an edge. The record ends when the vertex passes
/// back through this edge, or through a neighbouring edge to which it has slid. Until then the vertex has the
/// energy k_c [(d_s + D)^2 - d_s^2]/2. The depth D is the distance of the vertex from the edge; near an end
/// of the edges D is smaller (CrossingDepth). Other contacts of the vertex and its own edges with the crossed
/// edges are muted, because unsigned distances do not distinguish the sides. Instead, the muted contacts are
/// computed as if the vertex were nearer to the edge by D, so that it is usually on the edge. The energy is
/// therefore continuous where a vertex passes through an edge, comes back, or slips off an end.
class SelfCrossings {
 public:
  /// The last motion of the vertices: they moved to their present places with these velocities, for this
  /// time.
  struct Drift {
    const double *velocity_x, *velocity_y;  ///< [sqrt(sigma g)]
    double time;                            ///< [t0]
  };
  /// Records new crossings, and ends crossings when the vertex has returned.
  /// @return whether muted() has changed
  bool follow(const Contour& contour, const Drift& drift, const SelfContacts& contacts, DropletState& state);
  /// Finds the muted contacts of these crossings. Removes crossings that the contour does not have.
  void rebuild(const Contour& contour, std::vector<SelfCrossing>& crossings);

  /// A muted contact, which find_pushes() computes, and the number of the crossing that mutes it.
  struct Muted {
    SelfContacts::Pair pair;
    int crossing;
  };
  const std::vector<Muted>& muted() const { return muted_; }
  bool is_muted(const SelfContacts::Pair& pair) const;

  /// Finds pushes() of the crossings of the last rebuild(), with their muted contacts.
  /// @return the energy divided by the stiffness [sigma^2]; the pushes are its negative gradient
  double find_pushes(const Contour& contour, const SelfContacts& contacts);
  const std::vector<VertexPush>& pushes() const { return pushes_; }

 private:
  std::vector<CrossingPlace> places_;
  std::vector<Muted> muted_;  // sorted by pair
  std::vector<VertexPush> pushes_;
  // working memory
  std::vector<int> chain_;
  std::vector<CrossingDepth> depths_;

  void find_chain(const Contour& contour, const SelfCrossing& crossing, int most, bool bends);
  static int end_of_edges(const Contour& contour, const SelfCrossing& crossing, int step);
  bool heals(const Contour& contour, const Drift& drift, SelfCrossing& crossing);
  CrossingPlace look_at(const Contour& contour, const SelfCrossing& crossing,
                        const std::vector<SelfCrossing>& all);
  const CrossingDepth* depth_of(int vertex, int crossing, int num_vertices) const;
  double push_off(const Contour& contour, const Muted& muted, double range);
};

}  // namespace clog

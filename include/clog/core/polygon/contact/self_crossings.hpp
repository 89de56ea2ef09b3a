#pragma once

#include <array>
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
/// passes through the inside of an edge is recorded (SelfCrossing). Until its path leads back through the
/// edge, or through a neighbour of this edge to which it has slid, it has the energy
///   k_c [(d_s + D)^2 - d_s^2]/2.
/// Its depth D is its distance d from the edge. Where the edges end, at a sharp corner or at the vertex's own
/// edges, the vertex also comes out if its own edges slip off this end, so there D is at most the distance of
/// the end from them. Other contacts between the vertex or its edges and these edges are computed as if the
/// vertex were by D/d nearer to the edge, mostly on it, because unsigned distances do not know the side. So
/// the energy is continuous where a vertex passes through an edge, comes back, or slips off an end.
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

  /// A contact for which energy() and find_pushes() stand in, and the number of the crossing that mutes it.
  struct Muted {
    SelfContacts::Pair pair;
    int crossing;
  };
  const std::vector<Muted>& muted() const { return muted_; }
  bool is_muted(const SelfContacts::Pair& pair) const;

  /// Energy of the crossings of the last renew(), with their muted contacts, divided by the stiffness
  /// [sigma^2].
  double energy(const Contour& contour, const SelfContacts& contacts) const;
  struct Push {
    int vertex;
    Eigen::Array2d force;  ///< divided by the stiffness [sigma]
  };
  /// The negative gradient of energy(). @return valid until the next call
  const std::vector<Push>& find_pushes(const Contour& contour, const SelfContacts& contacts);

 private:
  /// An edge that leads from the crossed vertex, or from the last of its crossed neighbours, to a vertex that
  /// has not passed through.
  struct OwnEdge {
    int begin, end;
    bool crosses;  // whether it crosses the interface near the crossing's edge
  };
  struct Known {
    SelfCrossing crossing;
    std::array<int, 2> ends;  // vertices where the edges end on both sides, -1: not nearby
    std::array<OwnEdge, 2> own;
  };
  class Depth;
  struct Contact;
  std::vector<Known> known_;
  std::vector<Muted> muted_;  // sorted by pair
  std::vector<int> chain_;    // working memory
  std::vector<Push> pushes_;

  void find_chain(const Contour& contour, const SelfCrossing& crossing, int most, bool bends);
  static int end_of_edges(const Contour& contour, const SelfCrossing& crossing, int step);
  bool heals(const Contour& contour, const Drift& drift, SelfCrossing& crossing);
  Known look_at(const Contour& contour, const SelfCrossing& crossing, const std::vector<SelfCrossing>& all);
  std::vector<Depth> depths(const Contour& contour) const;
  template <class Visit>
  void visit_contacts(const Contour& contour, const SelfContacts& contacts, const std::vector<Depth>& depths,
                      Visit visit) const;
};

}  // namespace clog

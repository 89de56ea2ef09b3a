#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "clog/core/droplet_state.hpp"
#include "clog/core/wall_contacts.hpp"

namespace clog {

/// Pairs of a vertex and an edge of the same droplet that may touch.
///
/// Contact is between vertices and edges, so it holds when edges are longer than the vertex diameter. Every
/// edge within reach pushes by itself, with its own nearest point: then energy and force are continuous
/// wherever the vertex goes, also in a concave corner, where it is as near to two edges. Edges close along
/// the contour do not count as contact, or every vertex would touch its neighbours.
class SelfContacts {
 public:
  struct Pair {
    int vertex;
    int edge;  ///< edge e joins vertices e and e + 1 (mod N)
  };

  /// @param diameter  distance below which the interface repels itself [sigma]
  explicit SelfContacts(double diameter) : diameter_(diameter) {}

  /// Renews the pairs when the shape may change too much on the way to the next update.
  void update(const DropletState& state, const Travel& travel);
  void invalidate() { reference_.resize(0); }
  const std::vector<Pair>& pairs() const { return pairs_; }
  double diameter() const { return diameter_; }

  /// The same pairs by vertex: the edges of a group of WallContacts::edges_per_group are bits.
  struct Item {
    int vertex;
    int group;
    std::uint8_t edges;
  };
  const std::vector<Item>& items() const { return items_; }

 private:
  double diameter_;
  Eigen::ArrayXd reference_;  // positions relative to their mean when the pairs were made
  std::vector<Pair> pairs_;
  std::vector<Item> items_;
  std::vector<int> head_, next_;  // vertices by cell

  double skin_ = 0;  // of the present pairs
  void rebuild(const DropletState& state, double skin);
  void fill_items();
};

/// Nearest point of an edge to a vertex.
struct EdgeContact {
  double distance;  ///< [sigma]
  double fraction;  ///< the point's place on the edge, 0 at its first vertex, 1 at the next
  double dx, dy;    ///< from the point to the vertex [sigma]
};
EdgeContact nearest_point(const SelfContacts::Pair& pair, const double* x, const double* y, int num_vertices);

}  // namespace clog

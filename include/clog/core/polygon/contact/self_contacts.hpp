#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/polygon/contact/wall_contacts.hpp"

namespace clog {
namespace kernel {
struct VertexPair {
  int first, second;
};
}  // namespace kernel

/// Pairs of a vertex and an edge of the same droplet that may touch.
///
/// Contact is between vertices and edges, so it also works if edges are longer than the vertex diameter.
/// Every edge within reach pushes separately, from its own nearest point. So energy and force are continuous
/// for every path of the vertex, even in a concave corner, where two edges are equally near.
///
/// Edges close to a vertex along the contour do not count as contact, because otherwise every vertex would
/// touch its neighbours. An edge is close if it is less than three ranges away along the present contour, and
/// also fewer than exclusion() vertices away. In a compressed contour the number of vertices decides. This
/// number is fixed, so the contacts of a compressed contour do not depend on when the pairs were made. In a
/// stretched contour the distance decides, so that long edges cannot cross in a sharp fold.
class SelfContacts {
 public:
  struct Pair {
    int vertex;
    int edge;  ///< edge e joins vertices e and e + 1 (mod N)
  };

  /// @param range  distance below which the interface repels itself [sigma]
  /// @param rest_edge  length of an edge of the droplet at rest [sigma]
  SelfContacts(double range, double rest_edge) : range_(range) { set_rest_edge(rest_edge); }

  /// Sets the length of an edge at rest, for a droplet that grows.
  void set_rest_edge(double length);

  /// Rebuilds the pairs if the shape may change too much before the next update.
  void update(const DropletState& state, const Travel& travel);
  void invalidate() { reference_.resize(0); }
  /// Whether the present pairs stay valid until the next update.
  /// @param moved  bound on the displacement of any vertex since rebuild(), relative to the mean of all
  /// [sigma]
  bool hold(double moved, const Travel& travel) const;
  void rebuild(const DropletState& state, const Travel& travel);
  /// Positions of the vertices at the last rebuild(), relative to their mean: all x, then all y, then padding
  /// up to a whole number of SIMD vectors. Null if there are no pairs.
  const double* reference() const { return reference_.size() > 0 ? reference_.data() : nullptr; }
  const std::vector<Pair>& pairs() const { return pairs_; }
  double range() const { return range_; }
  /// Number of vertices that make up three ranges of the contour at rest.
  int exclusion() const { return exclusion_; }
  /// Whether these vertices are too close along the contour to count as in contact.
  bool are_neighbours(int a, int b) const;

  /// The pairs, arranged for vector instructions. An item has a group of WallContacts::edges_per_group edges
  /// and an equal number of consecutive vertices. Opposite strands of the contour run in opposite directions,
  /// so the last of these vertices is paired with the first edge. In a strand that is compressed until it
  /// touches itself, the directions are equal, so the first vertex is paired with the first edge.
  struct Item {
    int edges;           ///< first edge of a group
    int vertices;        ///< first vertex; vertex N + i is vertex i
    std::uint8_t pairs;  ///< bit b: whether edge `edges` + b and the b-th vertex are a pair
    bool backwards;      ///< whether vertices are counted from the last
  };
  const std::vector<Item>& items() const { return items_; }

 private:
  double range_;
  double rest_edge_ = 0;
  int exclusion_ = 1;
  Eigen::ArrayXd reference_;  // positions relative to their mean when the pairs were made
  std::vector<Pair> pairs_;
  std::vector<Item> items_;
  // Distance of each vertex from vertex 0 along the contour, followed by the length of the contour.
  std::vector<double> along_;
  std::vector<double> contour_;  // x, y and along_, with the beginning repeated; see kernel::CloseSearch
  std::vector<double> groups_;   // memory of the search
  std::vector<kernel::VertexPair> close_;
  std::vector<Pair> sorted_;       // memory of the sort
  std::vector<int> end_of_group_;  // for each group of edges, the index behind its last pair
  std::vector<int> item_of_;       // the latest item, by direction and first vertex

  double skin_ = 0;  // skin with which the present pairs were made [sigma]

  /// Fills along_. Returns the length of the longest edge.
  double measure_edges(const double* x, const double* y, int n);
  void find_close(const double* x, const double* y, double longest_edge, double reach);
  void rebuild_with_skin(const DropletState& state, double skin);
  void sort_pairs_by_groups(int n);
  void fill_items(const DropletState& state);
};

/// The point of an edge that is closest to a vertex.
struct EdgeContact {
  double distance;  ///< [sigma]
  double fraction;  ///< the point's place on the edge, 0 at its first vertex, 1 at the next
  double dx, dy;    ///< vector from the point to the vertex [sigma]
};
[[gnu::always_inline]] inline EdgeContact nearest_point(const SelfContacts::Pair& pair, const double* x,
                                                        const double* y, int num_vertices) {
  const int begin = pair.edge;
  const int end = begin + 1 < num_vertices ? begin + 1 : 0;
  const double ex = x[end] - x[begin];
  const double ey = y[end] - y[begin];
  const double rx = x[pair.vertex] - x[begin];
  const double ry = y[pair.vertex] - y[begin];
  const double fraction = std::clamp((rx * ex + ry * ey) / (ex * ex + ey * ey), 0.0, 1.0);
  const double dx = rx - fraction * ex;
  const double dy = ry - fraction * ey;
  return {std::sqrt(dx * dx + dy * dy), fraction, dx, dy};
}

}  // namespace clog

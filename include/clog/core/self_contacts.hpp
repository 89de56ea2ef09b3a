#pragma once

#include <Eigen/Core>
#include <vector>

#include "clog/core/droplet_state.hpp"

namespace clog {

/// Pairs of a vertex and a stretch of the same droplet's interface that may touch it.
///
/// Contact is between vertices and edges, so it holds when edges are longer than the vertex diameter.
/// Consecutive edges near one vertex form one strand, and only the strand's nearest point pushes: the force
/// then stays continuous where a vertex slides from one edge to the next. Edges close along the contour do
/// not count as contact, or every vertex would touch its neighbours.
class SelfContacts {
 public:
  struct Strand {
    int vertex;
    int first_edge;  ///< edge e joins vertices e and e + 1 (mod N)
    int num_edges;
  };

  /// @param diameter  distance below which the interface repels itself [sigma]
  explicit SelfContacts(double diameter) : diameter_(diameter) {}

  /// Renews the strands when the shape may change too much on the way to the next update.
  /// @param mean_edge  mean edge length [sigma]
  void update(const DropletState& state, const Travel& travel, double mean_edge);
  void invalidate() { reference_.resize(0); }
  const std::vector<Strand>& strands() const { return strands_; }
  double diameter() const { return diameter_; }

 private:
  double diameter_;
  Eigen::ArrayXd reference_;  // positions relative to their mean when the strands were made
  std::vector<Strand> strands_;
  std::vector<int> head_, next_;  // vertices by cell
  std::vector<int> near_edges_;

  double skin_ = 0;  // of the present strands
  void rebuild(const DropletState& state, double mean_edge, double skin);
};

/// Nearest point of a strand to its vertex.
struct StrandContact {
  double distance;  ///< [sigma]
  int edge;         ///< edge that holds the nearest point
  double fraction;  ///< its place on that edge, 0 at vertex `edge`, 1 at the next
  double dx, dy;    ///< from the nearest point to the vertex [sigma]
};
StrandContact nearest_point(const SelfContacts::Strand& strand, const double* x, const double* y,
                            int num_vertices);

}  // namespace clog

#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "clog/core/polygon/contact/wall_touch.hpp"

namespace clog {

struct VertexPush {
  int vertex;
  Eigen::Array2d force;  ///< divided by the stiffness of contact [sigma]
};

/// The place where the interface crosses itself because a vertex passed through an edge.
struct CrossingPlace {
  int vertex, edge;
  /// Vertices where the crossed edges end, forwards and backwards along the contour; -1: not nearby.
  std::array<int, 2> ends;
  /// An edge that begins at the crossed vertex, or at the last of its crossed neighbours, and ends at a
  /// vertex that has not passed through.
  struct OwnEdge {
    int begin, end;
    bool crosses;  ///< whether this edge crosses the interface near `edge`
  };
  std::array<OwnEdge, 2> own;
};

/// Distance of a crossed vertex from the interface that it passed through, and its place without the
/// crossing.
///
/// The vertex can return through the crossed edge. It can also return around an end of the crossed edges, if
/// both of its own edges slip off this end. Therefore the depth is the distance of the vertex from the
/// crossed edge, but it does not exceed a limit for each end. The limit is the distance from this end to the
/// farther one of the vertex's own edges that still cross.
class CrossingDepth {
 public:
  CrossingDepth(const Contour& contour, const CrossingPlace& place);

  int vertex() const { return vertex_; }
  double size() const { return is_limited() ? slip_.distance : distance_; }
  /// Moves the vertex towards the edge by the depth.
  Eigen::Array2d shift() const { return is_limited() ? slip_.distance * to_edge() : vector_to_edge_; }

  /// Adds `factor` times the gradient of size().
  void add_gradient(double factor, std::vector<VertexPush>& to) const;
  /// Adds the gradient of the scalar product of `factor` and shift().
  void add_gradient_of_shift(const Eigen::Array2d& factor, std::vector<VertexPush>& to) const;

 private:
  /// Distance from an end of the crossed edges to an edge of the vertex.
  struct Slip {
    double distance = std::numeric_limits<double>::infinity();
    int end = 0, own_begin = 0, own_end = 0;
    double fraction = 0;             // place on the vertex's edge of the point nearest to the end
    Eigen::Array2d direction{0, 0};  // from this point to the end
  };
  int vertex_, begin_, end_;
  double length_, fraction_, distance_;
  Eigen::Array2d tangent_, vector_to_edge_;
  bool is_beside_;  // whether the nearest point of the edge is not one of its ends
  Slip slip_;

  bool is_limited() const { return slip_.distance < distance_; }
  Eigen::Array2d to_edge() const {
    return distance_ > 0 ? vector_to_edge_ / distance_ : Eigen::Array2d(0, 0);
  }
  void limit_by(const Contour& contour, int end, const std::array<CrossingPlace::OwnEdge, 2>& own);
  void add_gradient_of_slip(double factor, std::vector<VertexPush>& to) const;
  void add_gradient_of_vector_to_edge(const Eigen::Array2d& factor, std::vector<VertexPush>& to) const;
};

}  // namespace clog

#pragma once

#include <span>
#include <vector>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/polygon/wall_contacts.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// A vertex that a wall pushes.
struct WallTouch {
  int vertex;
  WallPlace wall;
  double push;    ///< off the wall, as the contact hands it to the vertex [g rho sigma^2]
  double wetted;  ///< length of the interface on the wall that is the vertex' own [sigma]
};

/// Finds the vertices that walls push. Same contact as in DpForces.
class WallTouches {
 public:
  /// @param run  resolved parameters  @param obstacles  must outlive this
  WallTouches(const RunParameters& run, const ObstacleArray& obstacles);

  /// @param circles  all that may touch  @return valid until the next call
  const std::vector<WallTouch>& find(const DropletState& state, std::span<const WallContacts::Item> circles);

  /// Memory of whoever asks walls what they hold of what was found.
  KnownAnchors& known_anchors() { return known_anchors_; }

 private:
  /// What is known so far of a vertex and a wall.
  struct Part {
    int vertex;
    WallPlace wall;
    Eigen::Array2d push{0, 0};
    double wetted = 0;
    int next;  ///< part of the same vertex, -1: none
  };
  const ObstacleArray* obstacles_;
  double range_, stiffness_;
  bool meets_edges_;
  std::vector<int> first_part_;  // of each vertex
  std::vector<Part> parts_;
  std::vector<WallTouch> touches_;
  KnownAnchors known_anchors_;

  Part& part(int vertex, const WallPlace& wall);
  void add_edge(const Eigen::ArrayXd& position, int edge, const WallPlace& circle);
  void add_vertex(const Eigen::ArrayXd& position, int vertex, const WallPlace& wall, double distance,
                  const Eigen::Array2d& normal);
};

}  // namespace clog

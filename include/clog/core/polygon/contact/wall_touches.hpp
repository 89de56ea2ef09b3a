#pragma once

#include <array>
#include <span>
#include <vector>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/polygon/contact/wall_contacts.hpp"
#include "clog/core/polygon/contact/wall_touch.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// Finds the vertices that walls push, because walls can hold only these vertices by friction. The contacts
/// are those of DpForces.
class WallTouches {
 public:
  /// @param run  resolved parameters  @param obstacles  must outlive this
  WallTouches(const RunParameters& run, const ObstacleArray& obstacles);

  /// @param circles  circles that may touch the droplet
  /// @return valid until the next call
  const std::vector<WallTouch>& find(const Contour& contour, const LocalFrame& frame,
                                     std::span<const WallContacts::Item> circles);
  const std::vector<WallTouch>& find(const DropletState& state, std::span<const WallContacts::Item> circles);

  /// Working memory of WallFriction::follow().
  KnownAnchors& known_anchors() { return known_anchors_; }

 private:
  /// Sum over the contacts of one vertex with one wall.
  struct Part {
    int vertex;
    WallPlace wall;
    Eigen::Array2d push{0, 0};
    double wetted = 0;
    int next;  ///< next part of the same vertex; -1: none
  };
  const ObstacleArray* obstacles_;
  double range_, stiffness_;
  bool meets_edges_, acts_through_films_;
  std::vector<int> first_part_;  // first part of each vertex
  std::vector<Part> parts_;
  std::vector<WallPlace> wedges_;
  std::vector<WallTouch> touches_;
  std::vector<double> closed_contour_;
  // Data of each part: vector from the wall to the vertex (x, y), the wall's radius, normal (x, y), and
  // radius divided by distance.
  std::array<std::vector<double>, 6> directions_;
  KnownAnchors known_anchors_;

  int part(int vertex, const WallPlace& wall);
  void add_edges(const Contour& contour, const WallContacts::Item& item, const WallPlace& circle);
  void add_vertex(const Contour& contour, int vertex, const WallPlace& wall, double distance,
                  const Eigen::Array2d& normal);
  void keep_pushed(const Contour& contour);
};

}  // namespace clog

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// Thickness of the films between layers of the interface on a circle, see WallContacts; 0 if there are no
/// layers [sigma]. It is larger than the range of self-contact. Therefore chords of one layer, which are a
/// little lower than their arc, do not touch the next layer.
inline double film_thickness(const DpParameters& dp) {
  constexpr double room_for_chords = 1.25;
  const bool has_layers = dp.self_contact == SelfContact::on && dp.wall_contact == WallContact::edge;
  return has_layers ? room_for_chords * dp.self_contact_range : 0;
}

/// Lists of the obstacles near a polygon. `Keep` defines what is listed:
/// - `touched_by_edge`: edge i (from vertex i to the next) lists every obstacle with a surface that was
///   within `range` + skin of the edge.
/// - `touched_by_vertex`: vertex i lists every obstacle with a surface that was within `range` + skin of the
///   vertex.
/// - `nearest_to_vertex`: vertex i lists every obstacle that could become its nearest.
///
/// The lists are valid while no vertex has moved by more than the skin.
///
/// Where a droplet hangs over a circle, a second part of its interface may rest on the first, and further
/// parts on these. Such a stack has layers. Layer k has k other parts of the interface between itself and the
/// circle. In the model, layer k touches the circle directly, but the circle is enlarged by k times the
/// thickness `film`. So the circle carries each layer by a force along the circle's smooth normal. If layers
/// rested on each other instead, corners of their edges would interlock and transmit a tangential force,
/// which a film of liquid cannot transmit. Only lists of edges have layers.
class WallContacts {
 public:
  enum class Keep { touched_by_edge, touched_by_vertex, nearest_to_vertex };

  /// @param range  largest surface distance at which a wall force acts [sigma]
  /// @param film  thickness of each film between layers; 0: all edges are in layer 0 [sigma]
  WallContacts(const ObstacleArray& array, double range, Keep keep, double film = 0);

  /// Rebuilds the lists if a vertex may move by more than the skin before the next update.
  void update(const DropletState& state, const Travel& travel);
  /// Discards the lists. Call this when positions change without motion: when the frame's origin is shifted,
  /// or the polygon is rescaled.
  void invalidate() { reference_.resize(0); }
  /// Whether the present lists stay valid until the next update.
  /// @param moved  bound on the displacement of any vertex since rebuild() [sigma]
  bool hold(double moved, const Travel& travel) const;
  void rebuild(const DropletState& state, const Travel& travel);
  /// Positions of the vertices at the last rebuild(): all x, then all y, then padding up to a whole number of
  /// SIMD vectors. Null if there are no lists.
  const double* reference() const { return reference_.size() > 0 ? reference_.data() : nullptr; }

  double range() const { return range_; }
  /// Whether the circles in the lists all have the same radius.
  bool radii_are_equal() const { return smallest_radius_ == largest_radius_; }
  double largest_radius() const { return largest_radius_; }

  /// The lists in the form of items. An item is a circle and a group of `edges_per_group` edges (vertices),
  /// at least one of which lists the circle. Items of edges are sorted by circle, then by layer, then by
  /// group; items of vertices are sorted by group.
  struct Item {
    double x, y;   ///< centre, relative to the state's frame [sigma]
    double reach;  ///< radius + range + layer * film [sigma]
    int group;
    std::uint8_t edges;      ///< edges (vertices) of the group that list the circle, as bits
    std::uint8_t layer = 0;  ///< number of other parts of the interface between the circle and these edges
  };
  /// Edges in a higher layer count as edges of layer `highest_layer`.
  static constexpr int highest_layer = 3;
  static constexpr int edges_per_group = 8;
  const std::vector<Item>& items() const { return items_; }

 private:
  const ObstacleArray* array_;
  double range_, film_;
  Keep keep_;
  double skin_ = 0;  // skin with which the present lists were made [sigma]
  Eigen::Index num_points_ = 0;
  Eigen::ArrayXd reference_;
  std::vector<Obstacle> nearby_;
  std::vector<std::vector<int>> candidates_;
  struct Bounds {
    Eigen::Array2d least, most;
    double distance2(const Eigen::Array2d& place) const {
      return (least - place).max(place - most).max(0).square().sum();
    }
    bool overlap(const Bounds& other) const {
      return least[0] <= other.most[0] && least[1] <= other.most[1] && other.least[0] <= most[0] &&
             other.least[1] <= most[1];
    }
  };
  std::vector<Bounds> bounds_;  // for each group of edges
  /// A group of edges near one circle, and the edges that the circle may touch, as bits, for each layer.
  struct NearbyGroup {
    int group;
    std::array<std::uint8_t, highest_layer + 1> edges{};
  };
  std::vector<NearbyGroup> nearby_groups_;
  // Distance of each vertex from vertex 0 along the contour, followed by the length of the contour.
  std::vector<double> along_;
  double longest_edge_ = 0;
  Eigen::ArrayXXd distances_;  // distances of the vertices from the circles nearby, a column for each circle
  Eigen::ArrayXd nearest_;     // distance of each vertex from its nearest circle
  std::vector<std::size_t> item_of_;  // the latest item of each circle
  std::vector<Item> items_;
  double smallest_radius_ = 0, largest_radius_ = 0;

  void rebuild_with_skin(const DropletState& state, double skin);
  void gather_nearby(const DropletState& state);
  void list_by_edge(const Eigen::ArrayXd& position, const Eigen::ArrayXd& fine);
  void find_layers(const Obstacle& circle, const Eigen::ArrayXd& position, const Eigen::ArrayXd& fine);
  int num_parts_below(const Obstacle& circle, int edge, const Eigen::Array2d& place,
                      const Eigen::ArrayXd& position) const;
  void measure_distances(const DropletState& state);
  void list_by_vertex(const DropletState& state);
  void fill_items();
};

}  // namespace clog

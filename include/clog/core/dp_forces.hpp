#pragma once

#include <Eigen/Core>

#include "clog/core/droplet_state.hpp"
#include "clog/core/obstacle_array.hpp"
#include "clog/core/parameters.hpp"
#include "clog/core/polygon.hpp"
#include "clog/core/self_contacts.hpp"
#include "clog/core/wall_contacts.hpp"

namespace clog {

/// Terms of the potential energy of a deformable polygon [g rho sigma^3], Cheng et al. Eqs. 1-5.
struct DpEnergy {
  double area = 0;          ///< (k_a/2)(a - a0)^2
  double spring = 0;        ///< (k_l N_v/2) sum (l_i - l_ref)^2
  double line_tension = 0;  ///< gamma P
  double gravity = 0;       ///< -M g h, h measured from the frame's origin
  double wall = 0;          ///< (k_c/2) sum overlap^2 over edges and obstacles
  double self_contact = 0;  ///< (k_c/2) sum overlap^2 over vertices and strands of interface

  double total() const { return area + spring + line_tension + gravity + wall + self_contact; }
};

/// Potential energy of a deformable polygon among obstacles and its negative gradient.
/// Contacts act through lists: update_contacts() must have been called, and nothing have travelled farther
/// than it was told.
class DpForces {
 public:
  /// @param run  resolved parameters (see resolve())
  DpForces(const RunParameters& run, const ObstacleArray& obstacles);

  /// @param travel  bound on the way until the next call
  void update_contacts(const DropletState& state, const Travel& travel);
  /// To be called when local coordinates have moved by a shift of the frame.
  void forget_contacts();

  /// force = -grad U, all x then all y [g rho sigma^2]. Also measures shape() and, with near-wall drag,
  /// wall_distance().
  void evaluate(const DropletState& state, Eigen::ArrayXd& force);
  DpEnergy energy(const DropletState& state) const;

  /// Area and perimeter at the last evaluate().
  const PolygonShape& shape() const { return shape_; }
  /// Distance of each vertex to the nearest obstacle at the last evaluate(), not below half a vertex diameter
  /// [sigma]; empty without near-wall drag.
  const Eigen::ArrayXd& wall_distance() const { return wall_distance_; }
  /// Deepest overlap of an edge with an obstacle's contact range [sigma].
  double deepest_overlap(const DropletState& state) const;
  /// Distance from an obstacle's surface at which contact begins, half a vertex diameter [sigma].
  double contact_range() const { return walls_.range(); }

  double vertex_diameter() const { return vertex_diameter_; }

  /// For the release, where the droplet grows without weight.
  void set_rest_area(double area);
  void set_weight(double weight) { weight_ = weight; }

 private:
  DpParameters dp_;
  double vertex_diameter_;
  double contact_stiffness_;
  double rest_area_;
  double rest_edge_;
  double weight_;
  WallContacts walls_;
  WallContacts nearest_walls_;  // kept only with near-wall drag
  SelfContacts self_;
  PolygonShape shape_;
  Eigen::ArrayXd edge_x_, edge_y_, edge_length_, pull_, end_x_, end_y_;
  Eigen::ArrayXd wall_distance_;

  double spring_length() const;
  /// Calls visit(overlap) for every edge and slot [sigma]; negative where they do not touch.
  template <class Visit>
  void visit_overlaps(const DropletState& state, Visit visit) const;
  void add_centroid_weight(const DropletState& state, Eigen::ArrayXd& force) const;
  void add_self_contact(const DropletState& state, Eigen::ArrayXd& force) const;
};

}  // namespace clog

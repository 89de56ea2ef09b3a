#pragma once

#include <Eigen/Core>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/droplet/energy.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/polygon/contact/self_contacts.hpp"
#include "clog/core/polygon/contact/self_crossings.hpp"
#include "clog/core/polygon/contact/wall_contacts.hpp"
#include "clog/core/polygon/contact/wall_friction.hpp"
#include "clog/core/polygon/contact/wall_touches.hpp"
#include "clog/core/polygon/wetting/wetted_walls.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// Terms of the interface's force.
struct InterfaceTerms {
  double line_tension;   ///< tension gamma, without the springs
  double spring;         ///< stiffness k_l N_v of springs that carry tension
  double spring_length;  ///< rest length of these springs: l0, or the mean edge length
  double spreading;      ///< stiffness k_l N_v of springs that act only along the interface
  double pressure;       ///< pressure by the area's stiffness, -k_a (a - a0)
  double vertex_weight;  ///< weight of a vertex along +x, M g / N_v
};

/// Potential energy of a deformable polygon among obstacles, and the data from which the passes of a step
/// (DpStepper, RestForces) compute its negative gradient. Call update_contacts() first: the contact lists are
/// valid while no point moves farther than the argument of this call.
class DpForces {
 public:
  /// @param run  resolved parameters (see resolve())
  DpForces(const RunParameters& run, const ObstacleArray& obstacles);

  /// @param travel  bound on the displacement until the next call
  void update_contacts(const DropletState& state, const Travel& travel);
  /// Whether update_contacts() would leave the lists unchanged. Also returns false if the bounds in the
  /// arguments are too coarse to decide.
  /// @param moved  bound on the displacement of any vertex since walls() were rebuilt [sigma]
  /// @param moved_relative  bound on the displacement of any vertex relative to the mean of all, since
  /// self_contacts() were rebuilt [sigma]
  bool contacts_hold(double moved, double moved_relative, const Travel& travel) const;
  /// Whether there are valid contact lists.
  bool has_contact_lists() const {
    return walls_.reference() != nullptr &&
           (dp_.self_contact == SelfContact::off || self_.reference() != nullptr);
  }
  /// Discards the lists of obstacles. Call this when a shift of the frame has changed local coordinates.
  void forget_contacts();
  /// Also discards the pairs of self-contact, which a shift of the frame does not change.
  void forget_all_contacts();

  PotentialEnergy energy(const DropletState& state) const;

  /// Deepest overlap of the interface with a wall's contact range [sigma]. The key `wall-contact` determines
  /// whether edges or vertices overlap.
  double deepest_overlap(const DropletState& state) const;
  /// Distance from an obstacle's surface at which contact begins [sigma].
  double contact_range() const { return walls_.range(); }

  double vertex_diameter() const { return vertex_diameter_; }

  /// These functions return the data that the integrator needs: the terms of the interface at this area and
  /// perimeter, and the contacts.
  InterfaceTerms interface(double area, double perimeter) const;
  double contact_stiffness() const { return contact_stiffness_; }
  const WallContacts& walls() const { return walls_; }
  const WallContacts& nearest_walls() const { return nearest_walls_; }
  const SelfContacts& self_contacts() const { return self_; }
  const std::vector<Wedge>& wedges() const { return obstacles_->wedges(); }
  const WallFriction& friction() const { return friction_; }
  /// Moves the anchors of friction or of the contact line if the forces of their springs exceed their limits,
  /// see WallFriction::follow().
  /// @param circles  circles that may touch the droplet
  WallYield let_walls_yield(DropletState& state, WallTouches& touches,
                            std::span<const WallContacts::Item> circles, Purpose purpose) const;
  bool has_anchors() const { return friction_.is_on() || wetted_walls_.hold_ends(); }
  const WettedWalls& wetted_walls() const { return wetted_walls_; }

  /// These functions are for the release, where the droplet grows without weight.
  void set_rest_area(double area);
  void set_weight(double weight) { weight_ = weight; }
  double weight() const { return weight_; }

 private:
  DpParameters dp_;
  const ObstacleArray* obstacles_;
  double vertex_diameter_;
  double contact_stiffness_;
  double rest_area_;
  double rest_edge_;
  double weight_;
  bool has_near_wall_drag_;
  WallContacts walls_;
  WallContacts nearest_walls_;  // kept only with near-wall drag
  WettedWalls wetted_walls_;
  SelfContacts self_;
  WallFriction friction_;

  double self_contact_energy(const Contour& contour, const DropletState& state) const;
  /// Calls visit(overlap) for every half edge (or vertex) with every listed circle, and for every vertex with
  /// every wedge. The overlap [sigma] is negative where the two do not touch.
  template <class Visit>
  void visit_overlaps(const DropletState& state, Visit visit) const;
};

}  // namespace clog

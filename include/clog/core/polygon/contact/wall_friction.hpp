#pragma once

#include <span>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/parameters/circles.hpp"
#include "clog/core/polygon/contact/wall_touches.hpp"
#include "clog/core/world/wedge.hpp"

namespace clog {

/// k_t/k_c, the stiffness of the springs between interface and wall divided by the stiffness of the contact.
/// The value is usual for grains (Silbert et al., Phys. Rev. E 64, 051302 (2001)). With this value, a vertex
/// slips by mu k_c/k_t times the depth of the contact before its spring reaches the limit: 7 % of a vertex
/// diameter for mu = 1.
inline constexpr double friction_stiffness_ratio = 2.0 / 7;

/// Dry friction of walls, and a yield traction. When a wall begins to push a vertex, a spring ties the vertex
/// to the place of this first touch (Cundall and Strack, Geotechnique 29, 47 (1979)). The spring has the
/// energy U = (k_t/2) |s_i - s*_i|^2, and its force is at most mu N_i + tau_y w_i. Here s_i is the wall's
/// closest point to vertex i, s*_i the anchor, N_i the wall's normal force, and w_i the wetted length. Beyond
/// this limit the spring pulls its anchor along, so that the force stays at the limit.
class WallFriction {
 public:
  /// @param stiffness  k_t [g rho sigma]  @param wedges  must outlive this
  WallFriction(double coefficient, double yield_traction, double stiffness, std::span<const Wedge> wedges)
      : coefficient_(coefficient), traction_(yield_traction), stiffness_(stiffness), wedges_(wedges) {}

  bool is_on() const { return coefficient_ > 0 || traction_ > 0; }
  double coefficient() const { return coefficient_; }
  double yield_traction() const { return traction_; }  ///< [g rho sigma]
  double stiffness() const { return stiffness_; }      ///< k_t [g rho sigma]

  /// Adds the forces of the springs at their present anchors: all x, then all y [g rho sigma^2].
  void add_forces(const DropletState& state, Eigen::ArrayXd& force) const;
  /// [g rho sigma^3]
  double energy(const DropletState& state) const;
  /// How near the droplet is to sliding around a circle. For one circle, this is the moment of the springs'
  /// forces about the circle's centre, divided by the largest moment that friction can give with the present
  /// normal forces. It is 1 where the interface begins to slide. All layers on a circle count together.
  /// Returns the largest value of all circles; NaN if no circle touches the droplet. @param circles  in the
  /// droplet's coordinates
  double use(const DropletState& state, std::span<const WallTouch> touches,
             std::span<const Obstacle> circles) const;
  /// Moves anchors if the forces of their springs exceed the limit, adds anchors for new contacts, and
  /// removes anchors of ended contacts.
  /// @param state  the droplet whose anchors are updated
  /// @param touches  where walls push the droplet now
  /// @param known  working memory; its content is not kept between calls
  /// @param force  if not null, the forces of the springs are added to it: all x, then all y [g rho sigma^2]
  WallYield follow(DropletState& state, std::span<const WallTouch> touches, Purpose purpose,
                   KnownAnchors& known, Eigen::ArrayXd* force = nullptr) const;

 private:
  double coefficient_, traction_, stiffness_;
  std::span<const Wedge> wedges_;

  WallFoot foot(const DropletState& state, const WallAnchor& anchor) const;
  void add_force(const WallAnchor& anchor, const WallFoot& at, Eigen::ArrayXd& force) const;
};

}  // namespace clog

#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <optional>
#include <utility>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/tools/words.hpp"

namespace clog {

/// Largest distance of any coordinate (of a vertex, or of the soft disk) from its equilibrium value [sigma].
/// A droplet with a larger distance is not assumed to approach this equilibrium.
inline constexpr double farthest_rest = 0.03;
/// Smallest stiffness that an equilibrium must have against any displacement [M g/sigma]: the restoring force
/// divided by the displacement when the droplet moves as a whole.
inline constexpr double least_stiffness = 1e-3;

/// Coordinates of a displacement: first the normal components of all vertices (perpendicular to the chord
/// between a vertex's neighbours), then the tangential components. For the soft disk: x, y, both normal.
struct Axes {
  Eigen::SparseMatrix<double> directions;  ///< orthonormal columns over all x, then all y
  Eigen::Index num_tangential;  ///< number of the last columns, in which points slide along the interface
  /// Unit vector, in the tangential coordinates, of the motion in which all vertices slide along the
  /// interface; empty if this motion is tested like any other. A slide by one edge maps the polygon onto
  /// itself with its vertices renumbered, and does not move the droplet. The energy has small ripples along
  /// this slide, because the corners between edges touch obstacles. The slide decays last of all motions, so
  /// the droplet may be at the top of a ripple when the search begins. Therefore the search tests neither
  /// force nor stiffness along the slide.
  Eigen::VectorXd slide;
};

/// The forces on a droplet for the search.
struct EquilibriumForces {
  /// Updates the contact lists, which are then valid while no point moves farther than `travel`.
  std::function<void(const DropletState& state, const Travel& travel)> update_contacts;
  /// Forces on all points, all x then all y [g rho sigma^2].
  std::function<void(const DropletState& state, Eigen::ArrayXd& force)> evaluate;
  std::function<Axes(const DropletState& state)> axes;
  bool have_energy;  ///< whether the forces derive from an energy, so that the stiffness is symmetric

  /// @param forces  has update_contacts(state, travel) and evaluate(state, force); must outlive this
  template <class Forces>
  static EquilibriumForces of(Forces& forces, std::function<Axes(const DropletState& state)> axes,
                              bool have_energy) {
    return {
        [&forces](const DropletState& state, const Travel& travel) { forces.update_contacts(state, travel); },
        [&forces](const DropletState& state, Eigen::ArrayXd& force) { forces.evaluate(state, force); },
        std::move(axes), have_energy};
  }
};

/// The stable static equilibrium that a nearly stopped droplet approaches; nullopt if there is none, or if it
/// is not certain that the droplet would reach it.
///
/// The search applies Newton's method to the forces until they vanish within round-off. The potential energy
/// must be convex at the beginning, at the end, and wherever the search computes the stiffness in between.
/// All these places must be within `farthest_rest` of the initial place. If all this holds, the droplet and
/// the equilibrium are assumed to be in the same basin. So the search returns nullopt for a droplet that
/// balances on an obstacle, for a droplet that could drift aside freely, and for a droplet that creeps past a
/// place without an equilibrium.
///
/// @param initial  the droplet; its velocities have no effect
std::optional<DropletState> find_equilibrium(const EquilibriumForces& forces, const DropletState& initial);

/// Whether a droplet that has stopped would return after any small displacement.
enum class Stability {
  none,  ///< the droplet has not stopped
  stable,
  unstable,  ///< it balances: some displacement grows
  unknown    ///< the difference quotients of the forces do not decide
};
template <>
struct Words<Stability> {
  static constexpr Worded<Stability> all[] = {{Stability::none, "none"},
                                              {Stability::stable, "stable"},
                                              {Stability::unstable, "unstable"},
                                              {Stability::unknown, "unknown"}};
};

/// The stability of a droplet on which the forces nearly vanish. It follows from the smallest stiffness
/// against displacements in which the points adapt along the interface. The stiffness is a difference
/// quotient of forces. The function computes it twice, the second time with twice the step. The error of the
/// stiffness is the difference between the two results plus round-off. The droplet is stable if the smallest
/// stiffness is larger than its error, and unstable if it is below minus its error. Otherwise, or if the
/// points cannot adapt, the stability is unknown.
Stability stability_of(const EquilibriumForces& forces, const DropletState& stopped);

}  // namespace clog

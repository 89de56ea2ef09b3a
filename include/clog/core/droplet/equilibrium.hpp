#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <optional>
#include <utility>

#include "clog/core/droplet/droplet_state.hpp"

namespace clog {

/// How far any coordinate of a vertex, or of the soft disk, may be from its place at rest [sigma].
inline constexpr double farthest_rest = 0.03;
/// Smallest stiffness that an equilibrium must have against any displacement [M g/sigma]: the force that
/// pulls a droplet back, over the way it has been displaced as a whole.
inline constexpr double least_stiffness = 1e-3;

/// Coordinates of a displacement: of every vertex first that normal to the interface, to the chord between
/// its neighbours, then that along it. Of the soft disk: x, y.
struct Axes {
  Eigen::SparseMatrix<double> directions;  ///< orthonormal columns over all x, then all y
  /// The interface slides around itself: unit vector over the displacements along it, empty where that counts
  /// as any other motion. After one edge the polygon is the same again, with other names for its vertices:
  /// the energy only has ripples along this way, from the edges' corners on obstacles, and however far a
  /// droplet slides, it goes nowhere. So neither the force along it nor the stiffness is asked for. It is the
  /// last motion to die out, and may stand on top of a ripple now.
  Eigen::VectorXd slide;
};

/// The forces on a droplet, as the search asks for them.
struct EquilibriumForces {
  /// Where nothing moves farther than that until the next call.
  std::function<void(const DropletState& state, const Travel& travel)> update_contacts;
  /// Of all points, all x then all y [g rho sigma^2].
  std::function<void(const DropletState& state, Eigen::ArrayXd& force)> evaluate;
  std::function<Axes(const DropletState& state)> axes;
  bool have_energy;  ///< then the stiffness is symmetric

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

/// The stable static equilibrium next to a droplet that has nearly stopped, where it is about to come to
/// rest; nothing if there is none, or none that is certain to be the one that the droplet would reach.
///
/// Newton's method on the forces, until nothing is left of them but round-off. Every shape on the way must
/// lie where the potential energy is convex, and none may be farther than `farthest_rest` from the present
/// one: then both lie in one basin. A droplet that balances on an obstacle, that could drift aside freely, or
/// that creeps past a place where there is no equilibrium is refused.
///
/// @param initial  the droplet; its velocities do not count
std::optional<DropletState> find_equilibrium(const EquilibriumForces& forces, const DropletState& initial);

}  // namespace clog

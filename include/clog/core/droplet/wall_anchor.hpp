#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "clog/core/world/wedge.hpp"

namespace clog {

/// A wall near a droplet, in the droplet's frame: a circle, or a wedge of the scene. A circle enlarged by
/// films counts as a separate wall, see WallContacts.
struct WallPlace {
  double x = 0, y = 0;      ///< centre [sigma]
  double radius = 0;        ///< [sigma]
  Eigen::Index wedge = -1;  ///< number of the wedge; -1: a circle

  /// Whether both places are on the same wall. The lists of contacts may give the centre of one wall with
  /// different rounding errors; the centres of different walls differ by much more.
  bool is(const WallPlace& other) const {
    constexpr double rounding = 1e-6;
    return wedge == other.wedge && std::abs(x - other.x) < rounding && std::abs(y - other.y) < rounding &&
           std::abs(radius - other.radius) < rounding;
  }
};

/// Distance of a point from a wall.
/// @param wedges  the wedges of the scene
/// @param from_centre  vector from the wall's centre to the point
inline WedgeDistance distance_to(const WallPlace& wall, std::span<const Wedge> wedges,
                                 const Eigen::Array2d& from_centre) {
  if (wall.wedge >= 0) return distance_to(wedges[static_cast<std::size_t>(wall.wedge)], from_centre);
  const double r = from_centre.matrix().norm();
  return {r - wall.radius, from_centre / r};
}

/// Place on a wall to which a spring ties the interface. The anchor moves only when the spring's force
/// exceeds the wall's limit; until then the friction is static and its force is conservative. Anchors belong
/// to a droplet's state.
struct WallAnchor {
  Eigen::Index holder;  ///< what the spring holds: a vertex, or the first (0) or last (1) end of an arc
  WallPlace wall;       ///< the wall to which the spring is tied
  /// Position relative to the wall's centre; for the end of an arc, x is the coordinate along the wall
  /// [sigma].
  double x, y;
  double slip = 0;  ///< distance along the wall from the anchor to its holder at the last update [sigma]
  /// 1 if the wall yields. The spring's force then follows from `slip` alone, for any position of the holder.
  /// Only the search for an equilibrium uses this value; a moving droplet updates its anchors at every step.
  Eigen::Index yields = 0;

  double slip_of_force(double slip_now) const { return yields != 0 ? slip : slip_now; }
};

/// Finds anchors by the vertices or ends that they hold. Reuse the object, so that a step need not allocate
/// memory.
class KnownAnchors {
 public:
  /// Moves the anchors from `anchors` into this object.
  /// @param num_holders  find() finds only anchors with a holder below this number
  void take(std::vector<WallAnchor>& anchors, Eigen::Index num_holders) {
    std::swap(anchors_, anchors);
    anchors.clear();
    first_.assign(static_cast<std::size_t>(num_holders), none);
    next_.assign(anchors_.size(), none);
    for (std::size_t k = anchors_.size(); k-- > 0;)
      if (const Eigen::Index holder = anchors_[k].holder; holder >= 0 && holder < num_holders)
        next_[k] = std::exchange(first_[static_cast<std::size_t>(holder)], k);
  }
  /// The anchor that ties this holder to this wall; nullptr if there is none.
  WallAnchor* find(Eigen::Index holder, const WallPlace& wall) {
    std::size_t k = first_[static_cast<std::size_t>(holder)];
    while (k != none && !anchors_[k].wall.is(wall)) k = next_[k];
    return k == none ? nullptr : &anchors_[k];
  }
  const std::vector<WallAnchor>& all() const { return anchors_; }

 private:
  static constexpr std::size_t none = std::size_t(-1);
  std::vector<WallAnchor> anchors_;
  std::vector<std::size_t> first_, next_;  // a holder's first anchor; the next anchor of the same holder
};

/// What an update of the anchors is for.
enum class Purpose { motion, equilibrium };

/// The energy that walls dissipated, and the largest excess of a spring's force.
struct WallYield {
  double dissipated = 0;  ///< [g rho sigma^3]
  double excess = 0;      ///< largest amount by which a spring's force exceeds its limit [g rho sigma^2]

  /// Adds the spring energy of a removed anchor to the dissipated energy.
  void forget(const WallAnchor& anchor, double stiffness) {
    dissipated += 0.5 * stiffness * anchor.slip * anchor.slip;
    excess = std::max(excess, stiffness * std::abs(anchor.slip));
  }
  /// Limits the slip to the range from `least` to `most`, within which the wall does not yield. Returns the
  /// limited slip. The caller then moves the anchor by the difference between `slip` and the limited slip.
  double hold(WallAnchor& anchor, double slip, double least, double most, double stiffness, Purpose purpose) {
    const double held = std::clamp(slip, least, most);
    excess = std::max(excess, stiffness * std::abs(held - anchor.slip_of_force(slip)));
    // The trapezoidal rule, as in the integrator, multiplies the slip by the mean of the earlier and the
    // present force.
    dissipated += stiffness * (anchor.slip + held) / 2 * (slip - held);
    anchor.slip = held;
    anchor.yields = purpose == Purpose::equilibrium && held != slip ? 1 : 0;
    return held;
  }
};

}  // namespace clog

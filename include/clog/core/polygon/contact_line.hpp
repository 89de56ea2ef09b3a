#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/parameters/contact_angle.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/polygon/wall_contacts.hpp"
#include "clog/core/world/wedge.hpp"

namespace clog {

/// Do contact angles differ from Young's?
bool has_hysteresis(const DpParameters& dp);

/// How far the tension has changed to that of a wetted wall, and its derivative by the distance [1/sigma].
struct WettedShare {
  double share, slope;
};
/// A smooth step from 1 where contact begins to 0 in `width` beyond it, so that energies and forces are
/// continuous.
inline WettedShare wetted_share(double distance, double contact_range, double width) {
  const double t = std::clamp((contact_range + width - distance) / width, 0.0, 1.0);
  return {t * t * t * (10 + t * (6 * t - 15)), -30 * t * t * (1 - t) * (1 - t) / width};
}

/// k_p over Gamma and the vertex diameter, of the springs that hold the ends of wetted arcs. Before the wall
/// yields, an end then slips by half a vertex diameter times the difference of the angles' cosines.
inline constexpr double pinning_stiffness = 2;
/// Bound on the sum of squares of an end's gradient: shares of the last vertices, and their distances.
inline constexpr double pinning_gradient2 = 1.5;

/// Contact-angle hysteresis. The end of a wetted arc is at
///   q = u_m + sum share_e (u_e' - u_e)
/// along the wall, u the wall's own coordinate, summed over the edges e from a wetted vertex m outwards,
/// share_e their share of wetting; counted positive outwards. Over a smooth interface its gradient is normal
/// to that: an end is a place, whichever vertices are there. A spring holds it,
///   U = (k_p/2) (q - q*)^2,  -Gamma (cos Y - cos A) <= f <= Gamma (cos R - cos Y),
/// Y, A, R Young's, the advancing and the receding angle. A spring that asks for more than the wall bears
/// pulls its anchor q* along, so that the wall just bears it.
class ContactLine {
 public:
  /// @param run  resolved parameters  @param wedges  must outlive this
  ContactLine(const RunParameters& run, std::span<const Wedge> wedges);

  bool is_on() const { return is_on_; }

  /// One end of a wetted arc.
  struct End {
    WallPlace wall;
    Eigen::Index side;  ///< 0: the arc's first, 1: its last along the contour
    double place;       ///< q, counted outwards [sigma]
    std::vector<std::pair<Eigen::Index, Eigen::Array2d>> gradient;  ///< of q by the vertices
  };
  /// @param circles  all that may be wetted, by vertex
  std::vector<End> ends(const DropletState& state, std::span<const WallContacts::Item> circles) const;

  /// Of the springs as they are anchored: all x, then all y [g rho sigma^2].
  void add_forces(const DropletState& state, std::span<const End> ends, Eigen::ArrayXd& force) const;
  /// [g rho sigma^3]
  double energy(const DropletState& state, std::span<const End> ends) const;
  /// Lets walls yield: anchors follow. An end keeps the nearest anchor of its wall and side; new ends get one
  /// of their own, and the anchors of ends that are no more are forgotten.
  WallYield follow(DropletState& state, std::span<const End> ends, Purpose purpose) const;

 private:
  struct Zone;
  bool is_on_;
  double stiffness_, most_outwards_, most_inwards_;  // k_p, and limits of the force
  double contact_range_, width_;                     // of the contact and of the share's fall [sigma]
  std::span<const Wedge> wedges_;

  void add_to(Zone& zone, const DropletState& state, Eigen::Index vertex) const;
  void add_ends(const Zone& zone, const DropletState& state, std::vector<End>& ends) const;
  /// Of each end the number of its anchor, -1: none.
  static std::vector<Eigen::Index> matched(const DropletState& state, std::span<const End> ends);
};

}  // namespace clog

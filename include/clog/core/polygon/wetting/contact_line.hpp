#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/parameters/contact_angle.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/polygon/contact/wall_contacts.hpp"
#include "clog/core/world/wedge.hpp"

namespace clog {

/// Whether contact angles differ from Young's.
bool has_hysteresis(const DpParameters& dp);

/// Wetted fraction, from 0 to 1, and its derivative with respect to the distance [1/sigma].
struct WettedShare {
  double share, slope;
};
/// The wetted fraction is 1 up to `contact_range`, and 0 from `contact_range` + `width` on. It changes by a
/// smooth step, so that energies and forces are continuous.
inline WettedShare wetted_share(double distance, double contact_range, double width) {
  const double t = std::clamp((contact_range + width - distance) / width, 0.0, 1.0);
  return {t * t * t * (10 + t * (6 * t - 15)), -30 * t * t * (1 - t) * (1 - t) / width};
}

/// Stiffness k_p of the springs that hold the ends of wetted arcs, in units of Gamma per vertex diameter.
/// With this value, an end slips by half a vertex diameter times the difference of the angles' cosines before
/// its spring reaches the limit.
inline constexpr double pinning_stiffness = 2;
/// Bound on the squared norm of the gradient of q (see ContactLine). Two things contribute to this gradient:
/// the wetted fractions of the last vertices, and the dependence of these fractions on the vertices'
/// distances from the wall.
inline constexpr double pinning_gradient2 = 1.5;

/// The vertices of a droplet.
struct VertexPlaces {
  Eigen::Index size;
  const double *x, *y;  ///< [sigma]
  explicit VertexPlaces(const DropletState& state)
      : VertexPlaces(state.size(), state.position.data(), state.position.data() + state.size()) {}
  VertexPlaces(Eigen::Index num_vertices, const double* all_x, const double* all_y)
      : size(num_vertices), x(all_x), y(all_y) {}
};

/// Contact-angle hysteresis. The end of a wetted arc has the coordinate q along the wall, positive outwards:
///   q = u_m + sum share_e (u_e' - u_e).
/// Here u is the coordinate of a vertex along the wall, and m a wetted vertex. The sum runs over the edges e
/// from m outwards; share_e is an edge's wetted fraction, u_e and u_e' are the coordinates of its two ends.
/// Where the interface is smooth, the gradient of q is normal to the interface. So q does not change when
/// vertices slide along the interface. A spring with the force f holds q:
///   U = (k_p/2) (q - q*)^2,  -Gamma (cos Y - cos A) <= f <= Gamma (cos R - cos Y),
/// with Young's angle Y, the advancing angle A and the receding angle R. Beyond these limits the spring pulls
/// its anchor q* along, so that the force stays at the limit.
class ContactLine {
 public:
  /// @param run  resolved parameters  @param wedges  must outlive this
  ContactLine(const RunParameters& run, std::span<const Wedge> wedges);

  bool is_on() const { return is_on_; }

  /// One end of a wetted arc.
  struct End {
    WallPlace wall;
    Eigen::Index side;  ///< 0: the arc's first end along the contour, 1: its last end
    double place;       ///< q, counted outwards [sigma]
    /// The range in Ends::gradients that contains the derivatives of q with respect to vertices.
    std::size_t first_gradient, num_gradients;
  };
  struct Gradient {
    Eigen::Index vertex;
    Eigen::Array2d by_place;
  };
  class Ends;
  /// @param circles  circles that may be wetted, listed by vertex @param ends  the result; its memory is
  /// reused
  void find_ends(const VertexPlaces& vertices, const LocalFrame& frame,
                 std::span<const WallContacts::Item> circles, Ends& ends) const;

  /// Adds the forces of the springs at their present anchors: all x, then all y [g rho sigma^2].
  void add_forces(std::span<const WallAnchor> anchors, const Ends& ends, Eigen::ArrayXd& force) const;
  /// [g rho sigma^3]
  double energy(std::span<const WallAnchor> anchors, const Ends& ends) const;
  /// Moves anchors if the forces of their springs exceed their limits. Each end keeps the nearest anchor on
  /// its wall and on its side of the arc. A new end gets a new anchor, and anchors of vanished ends are
  /// removed. Afterwards there is one anchor for each end, in the order of the ends.
  WallYield follow(std::vector<WallAnchor>& anchors, const Ends& ends, Purpose purpose) const;

 private:
  struct Zone;
  struct Beside;
  bool is_on_;
  double stiffness_, most_outwards_, most_inwards_;  // k_p, and limits of the force
  double contact_range_,
      width_;  // range of the contact, and width of the zone beyond it in which the wetted fraction falls to
               // 0 [sigma]
  std::span<const Wedge> wedges_;

  Beside beside(const WallPlace& wall, const VertexPlaces& vertices, Eigen::Index vertex) const;
  void add_to(Zone& zone, const VertexPlaces& vertices, Eigen::Index vertex) const;
  void add_ends(const Zone& zone, const VertexPlaces& vertices, Ends& ends) const;
  /// The number of each end's anchor; -1: none. Valid until the next call.
  static const std::vector<Eigen::Index>& matched(std::span<const WallAnchor> anchors, const Ends& ends);
};

/// A wall near the interface, and the vertices near it in the order of their numbers.
struct ContactLine::Zone {
  WallPlace wall;
  struct Vertex {
    Eigen::Index vertex;
    double share, slope;
    Eigen::Array2d normal;
  };
  std::vector<Vertex> vertices;
};

/// The ends of wetted arcs, and memory for finding these ends and for matching them with anchors.
class ContactLine::Ends {
 public:
  const std::vector<End>& all() const { return all_; }
  std::span<const Gradient> gradients(const End& end) const {
    return std::span(gradients_).subspan(end.first_gradient, end.num_gradients);
  }

 private:
  friend class ContactLine;
  std::vector<End> all_;
  std::vector<Gradient> gradients_;
  std::vector<Zone> zones_;  // only the first num_zones_ are in use
  std::size_t num_zones_ = 0;
  struct Match {
    double way;
    std::size_t end, anchor;
  };
  mutable std::vector<Match> matches_;
  mutable std::vector<Eigen::Index> anchor_of_;
  mutable std::vector<char> is_taken_;
  mutable std::vector<WallAnchor> after_;

  Zone& add_zone(const WallPlace& wall);
};

}  // namespace clog

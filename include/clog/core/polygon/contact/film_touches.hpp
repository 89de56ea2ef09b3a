#pragma once

#include <span>
#include <vector>

#include "clog/core/polygon/contact/self_contacts.hpp"
#include "clog/core/polygon/contact/wall_touch.hpp"
#include "clog/core/world/wedge.hpp"

namespace clog {

/// Largest number of films through which a wall holds interfaces.
inline constexpr double most_films = 3;
/// Largest distance from the surface of a wall at which friction acts through films [sigma].
/// @param wall_range  distance at which a wall's contact begins
/// @param self_range  see SelfContacts
inline double film_reach(double wall_range, double self_range) {
  return wall_range + most_films * self_range;
}

/// A force below this fraction of k_c times the range of self-contact may be round-off, and counts as zero.
inline constexpr double least_film_push = 1e-9;

/// Friction through closed films. If one part of the interface lies on another, the wall pushes the lower
/// part, and the lower part pushes the upper part. The lower part passes a share of the wall's push on to the
/// upper part and keeps the rest. So the normal force that determines the friction of vertex i is
///   N_i = max(0, n (P_i + S_i)),
/// where P_i is the wall's push on the vertex, S_i the push of the droplet's other parts, and n the wall's
/// normal. S_i counts for only one wall, the nearest of those that push the droplet, and only within
/// film_reach() of its surface. At rest N_i balances the force with which the tension of the vertex's own
/// part of the interface presses on the wall. The N_i of all parts in a stack add up to the push of the wall,
/// so that the total friction obeys Coulomb's law.
class FilmTouches {
 public:
  /// @param wall_range  distance from a wall's surface at which contact begins [sigma]
  /// @param stiffness  k_c of the self-contact [g rho sigma]
  /// @param wedges  must outlive this
  FilmTouches(double wall_range, double stiffness, std::span<const Wedge> wedges)
      : wall_range_(wall_range), stiffness_(stiffness), wedges_(wedges) {}

  /// Changes the pushes in `touches`, and adds touches through films.
  void add_to(std::vector<WallTouch>& touches, const Contour& contour, const SelfContacts& self);

 private:
  double wall_range_, stiffness_;
  std::span<const Wedge> wedges_;
  std::vector<WallPlace> walls_;               // walls that push the droplet
  std::vector<Eigen::Array2d> pushes_;         // pushes of self-contact on each vertex; zero between calls
  std::vector<int> pushed_;                    // vertices with a push of self-contact
  std::vector<int> first_touch_, next_touch_;  // a vertex's first touch; the next touch of the same vertex

  void find_walls(const std::vector<WallTouch>& touches);
  void find_pushes(const Contour& contour, const SelfContacts& self);
  void add_push(int vertex, const Eigen::Array2d& push);
  void add_vertex(int vertex, const Contour& contour, double reach, double least,
                  std::vector<WallTouch>& touches);
};

}  // namespace clog

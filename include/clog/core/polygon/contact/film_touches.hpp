#pragma once

#include <span>
#include <vector>

#include "clog/core/polygon/contact/self_contacts.hpp"
#include "clog/core/polygon/contact/wall_touch.hpp"
#include "clog/core/world/wedge.hpp"

namespace clog {

/// Largest number of films through which a wall holds interfaces.
inline constexpr double most_films = 3;
/// How far from the surface of a wall friction through films reaches [sigma].
/// @param wall_range  distance at which a wall's contact begins
/// @param self_range  see SelfContacts
inline double film_reach(double wall_range, double self_range) {
  return wall_range + most_films * self_range;
}

/// Forces below this fraction of k_c times the range of self-contact may be round-off and count as zero.
inline constexpr double least_film_push = 1e-9;

/// Friction through closed films. An interface that lies on another one feels the wall through the force by
/// which the lower interface pushes it off; the lower interface keeps the rest of the wall's push:
///   N_i = max(0, n (P_i + S_i)),
/// P_i the wall's push on vertex i, S_i the push of the droplet's other parts, n the wall's normal. S_i
/// counts only for one wall, the nearest of those that push the droplet, and only within film_reach() of its
/// surface. At rest N_i balances the force with which the interface's own tension presses on the wall. The
/// N_i of all interfaces of a stack add up to the push of the wall, so that its total friction obeys
/// Coulomb's law.
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
  std::vector<WallPlace> walls_;               // that push the droplet
  std::vector<Eigen::Array2d> pushes_;         // of self-contact on each vertex; zero between calls
  std::vector<int> pushed_;                    // vertices with a push of self-contact
  std::vector<int> first_touch_, next_touch_;  // a vertex's first touch; the next touch of the same vertex

  void find_walls(const std::vector<WallTouch>& touches);
  void find_pushes(const Contour& contour, const SelfContacts& self);
  void add_push(int vertex, const Eigen::Array2d& push);
  void add_vertex(int vertex, const Contour& contour, double reach, double least,
                  std::vector<WallTouch>& touches);
};

}  // namespace clog

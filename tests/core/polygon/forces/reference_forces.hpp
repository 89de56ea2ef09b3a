#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "clog/core/droplet/shape.hpp"
#include "clog/core/polygon/forces/dp_forces.hpp"
#include "clog/core/world/wedge.hpp"
#include "core/polygon/contact/wedge_place.hpp"

namespace clog::test {

/// Computes the force of DpForces by plain loops. Tests compare the vectorised step with it. Edge i joins
/// vertices i and i + 1, and the last edge closes the contour.
class ReferenceForces : public DpForces {
 public:
  ReferenceForces(const RunParameters& run, const ObstacleArray& obstacles)
      : DpForces(run, obstacles),
        run_(run),
        n_(*run.dp.vertices),
        wetting_(n_),
        centroid_gradient_(Eigen::ArrayXd::Zero(Eigen::Index{4} * n_)) {}

  /// The force -grad U, with all x first and then all y [g rho sigma^2]. update_contacts() must have been
  /// called.
  void evaluate(const DropletState& state, Eigen::ArrayXd& force) {
    position_ = state.position;
    force = interface_force();
    Eigen::Array2d net_spreading{force.head(n_).sum(), force.tail(n_).sum()};
    if (wetted_walls().is_on()) {
      wetted_walls().find_forces(VertexPlaces(state), state.frame, state.anchors, wetting_);
      force += wetting_.gradient + wetting_.spreading;
      net_spreading += wetting_.net_spreading;
    }
    if (run_.dp.gravity == Gravity::area) {
      // The forces of tension and pressure add up to zero. The springs along the interface pull vertices
      // against the liquid, not against other vertices. The liquid is part of the droplet, so the sum of the
      // spring forces (`net_spreading`) must not move the droplet.
      find_centroid_gradient();
      for (int i = 0; i < n_; ++i)
        add(force, i,
            (weight() - net_spreading[0]) * gradient_of(0, i) - net_spreading[1] * gradient_of(1, i));
    }
    add_walls(state, force);
    if (friction().is_on()) friction().add_forces(state, force);
    if (run_.dp.self_contact == SelfContact::on) add_self_contact(force);
    if (run_.drag.near_wall > 0) find_wall_distance(state);
  }

  /// Distance of each vertex from the nearest obstacle at the last evaluate(), but at least the cutoff of the
  /// near-wall drag [sigma]. The array is empty without near-wall drag.
  const Eigen::ArrayXd& wall_distance() const { return wall_distance_; }
  /// Derivatives d(X, Y)/d(x_i, y_i) at the last evaluate(). X and Y are the coordinates of the area's
  /// centroid. The array contains dX/dx, dX/dy, dY/dx and dY/dy, each of length N_v. The array is zero if the
  /// weight acts on the vertices.
  const Eigen::ArrayXd& centroid_gradient() const { return centroid_gradient_; }

 private:
  RunParameters run_;
  int n_;
  WettedWalls::Forces wetting_;
  Eigen::ArrayXd position_, centroid_gradient_, wall_distance_;

  int wrapped(int i) const { return (i + n_) % n_; }
  Eigen::Array2d vertex(int i) const { return {position_[wrapped(i)], position_[n_ + wrapped(i)]}; }
  Eigen::Array2d edge(int i) const { return vertex(i + 1) - vertex(i); }
  double length(int i) const { return edge(i).matrix().norm(); }
  /// The middle of the refined edge by the four-point rule.
  Eigen::Array2d middle(int i) const {
    return refined_near * (vertex(i) + vertex(i + 1)) + refined_far * (vertex(i - 1) + vertex(i + 2));
  }
  void add(Eigen::ArrayXd& force, int i, const Eigen::Array2d& what) const {
    force[wrapped(i)] += what[0];
    force[n_ + wrapped(i)] += what[1];
  }
  Eigen::Array2d gradient_of(int axis, int i) const {
    return {centroid_gradient_[2 * axis * n_ + i], centroid_gradient_[(2 * axis + 1) * n_ + i]};
  }

  /// The forces of tension, springs, pressure, and of the weight on the vertices.
  Eigen::ArrayXd interface_force() const {
    const PolygonShape shape = polygon_shape(position_);
    const InterfaceTerms terms = interface(shape.area, shape.perimeter);
    // The vector of the edge, multiplied by (gamma + k_l N_v (l - l_ref))/l.
    const auto pull = [&](int i) -> Eigen::Array2d {
      return (terms.line_tension + terms.spring * (length(i) - terms.spring_length)) / length(i) * edge(i);
    };
    Eigen::ArrayXd force = Eigen::ArrayXd::Zero(Eigen::Index{2} * n_);
    for (int i = 0; i < n_; ++i) {
      // The gradient of the area is half the chord between the neighbours, turned outwards. Springs along the
      // interface pull along this chord, so that they do no work on the area.
      const Eigen::Array2d chord = vertex(i + 1) - vertex(i - 1);
      const double cosine = std::max(0.0, (edge(i) * edge(i - 1)).sum()) / (length(i) * length(i - 1));
      const double spread =
          terms.spreading * cosine * cosine * (length(i) - length(i - 1)) / (length(i) + length(i - 1));
      add(force, i, pull(i) - pull(i - 1) + spread * chord);
      add(force, i, terms.pressure / 2 * Eigen::Array2d(chord[1], -chord[0]));
      add(force, i, {terms.vertex_weight, 0});
    }
    return force;
  }

  /// Integrates a dX = integral of (x - X) times the outward displacement over the surface. Along an edge,
  /// q = x - X changes linearly, so vertex i gets (2 q_i + q_j)/6 times the outward normal of the edge.
  void find_centroid_gradient() {
    const double area = polygon_shape(position_).area;
    const Eigen::Array2d centre = area_centroid(position_);
    for (int i = 0; i < n_; ++i)
      for (const int axis : {0, 1}) {
        const auto part = [&](int other) {
          return (2 * vertex(i)[axis] + vertex(other)[axis] - 3 * centre[axis]) / (6 * area);
        };
        const Eigen::Array2d sum = part(i + 1) * edge(i) + part(i - 1) * edge(i - 1);
        centroid_gradient_[2 * axis * n_ + i] = sum[1];
        centroid_gradient_[(2 * axis + 1) * n_ + i] = -sum[0];
      }
  }

  /// Calls visit(item, i) for each pair of a circle in the contact lists and an edge or vertex i near it.
  template <class Visit>
  void for_each_listed(const WallContacts& contacts, Visit visit) const {
    for (const WallContacts::Item& item : contacts.items())
      for (int bit = 0; bit < WallContacts::edges_per_group; ++bit)
        if (item.edges >> bit & 1) visit(item, item.group * WallContacts::edges_per_group + bit);
  }

  void add_walls(const DropletState& state, Eigen::ArrayXd& force) const {
    for_each_listed(walls(), [&](const WallContacts::Item& item, int i) {
      const Eigen::Array2d centre(item.x, item.y);
      if (run_.dp.wall_contact == WallContact::vertex) {
        add(force, i, push(vertex(i) - centre, item.reach));
      } else {
        push_half_edge(force, i, true, centre, item.reach);
        push_half_edge(force, i, false, centre, item.reach);
      }
    });
    // Edges are not tested against wedges, because they touch the tip of a wedge first, and the tip is a
    // circle.
    for (const Wedge& wedge : wedges()) {
      const kernel::WedgePlace place = kernel::place_in(state.frame, wedge);
      for (int i = 0; i < n_; ++i) {
        const auto surface = distance_to(wedge, vertex(i) - Eigen::Array2d(place.x, place.y));
        add(force, i,
            contact_stiffness() * std::max(0.0, walls().range() - surface.distance) * surface.normal);
      }
    }
  }
  /// The push k_c * (reach - d) along `away`. The length of `away` is d.
  Eigen::Array2d push(const Eigen::Array2d& away, double reach) const {
    const double d = away.matrix().norm() + 1e-300;  // avoids NaN for a point that is exactly at the centre
    return contact_stiffness() * std::max(0.0, reach - d) / d * away;
  }
  /// The position of the nearest point decides how the two ends of the half edge share the push. A force on a
  /// middle acts on the four vertices that determine the middle.
  void push_half_edge(Eigen::ArrayXd& force, int i, bool is_first, const Eigen::Array2d& centre,
                      double reach) const {
    const Eigen::Array2d begin = is_first ? vertex(i) : middle(i), end = is_first ? middle(i) : vertex(i + 1);
    const Eigen::Array2d half = end - begin;
    const double fraction =
        std::clamp((half * (centre - begin)).sum() / std::max(half.square().sum(), 1e-200), 0.0, 1.0);
    const Eigen::Array2d whole = push(begin + fraction * half - centre, reach);
    add(force, is_first ? i : i + 1, (is_first ? 1 - fraction : fraction) * whole);
    const Eigen::Array2d of_middle = (is_first ? fraction : 1 - fraction) * whole;
    for (const int near : {i, i + 1}) add(force, near, refined_near * of_middle);
    for (const int far : {i - 1, i + 2}) add(force, far, refined_far * of_middle);
  }

  void add_self_contact(Eigen::ArrayXd& force) const {
    for (const SelfContacts::Pair& pair : self_contacts().pairs()) {
      const EdgeContact contact = nearest_point(pair, position_.data(), position_.data() + n_, n_);
      const Eigen::Array2d whole = push({contact.dx, contact.dy}, self_contacts().range());
      add(force, pair.vertex, whole);
      add(force, pair.edge, -(1 - contact.fraction) * whole);
      add(force, pair.edge + 1, -contact.fraction * whole);
    }
  }

  void find_wall_distance(const DropletState& state) {
    wall_distance_.setConstant(n_, std::numeric_limits<double>::infinity());
    const auto shrink = [&](int i, double d) { wall_distance_[i] = std::min(wall_distance_[i], d); };
    for_each_listed(nearest_walls(), [&](const WallContacts::Item& item, int i) {
      const double radius = item.reach - nearest_walls().range();
      shrink(i, (vertex(i) - Eigen::Array2d(item.x, item.y)).matrix().norm() - radius);
    });
    for (const Wedge& wedge : wedges()) {
      const kernel::WedgePlace place = kernel::place_in(state.frame, wedge);
      for (int i = 0; i < n_; ++i)
        shrink(i, distance_to(wedge, vertex(i) - Eigen::Array2d(place.x, place.y)).distance);
    }
    wall_distance_ = wall_distance_.max(run_.drag.near_wall_cutoff);
  }
};

/// The largest difference between the force and the central difference of the energy.
inline double force_error(ReferenceForces& forces, DropletState state) {
  constexpr double h = 1e-6;
  forces.update_contacts(state, {});
  Eigen::ArrayXd force(state.position.size());
  forces.evaluate(state, force);
  double worst = 0;
  for (Eigen::Index i = 0; i < state.position.size(); ++i) {
    const double middle = state.position[i];
    state.position[i] = middle + h;
    const double above = forces.energy(state).total();
    state.position[i] = middle - h;
    const double below = forces.energy(state).total();
    state.position[i] = middle;
    worst = std::max(worst, std::abs(force[i] + (above - below) / (2 * h)));
  }
  return worst;
}

}  // namespace clog::test

#include "clog/core/polygon/forces/dp_forces.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "clog/core/droplet/shape.hpp"
#include "clog/core/tools/units.hpp"
#include "core/polygon/contact/wedge_place.hpp"

namespace clog {

DpForces::DpForces(const RunParameters& run, const ObstacleArray& obstacles)
    : dp_(run.dp),
      obstacles_(&obstacles),
      vertex_diameter_(units::regular_edge_length(*run.dp.vertices)),
      contact_stiffness_(clog::contact_stiffness(run.wall_stiffness.value(), vertex_diameter_)),
      weight_(units::droplet_mass * units::gravity),
      has_near_wall_drag_(run.drag.near_wall > 0),
      walls_(obstacles, dp_.contact_range.value(),
             dp_.wall_contact == WallContact::edge ? WallContacts::Keep::touched_by_edge
                                                   : WallContacts::Keep::touched_by_vertex,
             film_thickness(dp_)),
      nearest_walls_(obstacles, dp_.contact_range.value(), WallContacts::Keep::nearest_to_vertex),
      wetted_walls_(run, obstacles),
      self_(dp_.self_contact_range, vertex_diameter_),
      friction_(dp_.friction, dp_.yield_traction, friction_stiffness_ratio * contact_stiffness_,
                obstacles.wedges()) {
  assert(run.dp.vertices && run.dp.perimeter_stiffness);
  set_rest_area(units::rest_area);
}

void DpForces::set_rest_area(double area) {
  rest_area_ = area;
  rest_edge_ = units::regular_edge_length(*dp_.vertices, area);
  self_.set_rest_edge(rest_edge_);
}

void DpForces::update_contacts(const DropletState& state, const Travel& travel) {
  walls_.update(state, travel);
  if (has_near_wall_drag_) nearest_walls_.update(state, travel);
  if (wetted_walls_.is_on()) wetted_walls_.lists().update(state, travel);
  if (dp_.self_contact == SelfContact::on) self_.update(state, travel);
}

bool DpForces::contacts_hold(double moved, double moved_relative, const Travel& travel) const {
  if (has_near_wall_drag_ || wetted_walls_.is_on()) return false;
  return walls_.hold(moved, travel) &&
         (dp_.self_contact == SelfContact::off || self_.hold(moved_relative, travel));
}

void DpForces::forget_contacts() {
  walls_.invalidate();
  nearest_walls_.invalidate();
  wetted_walls_.lists().invalidate();
}

void DpForces::forget_all_contacts() {
  forget_contacts();
  self_.invalidate();
}

InterfaceTerms DpForces::interface(double area, double perimeter) const {
  const bool has_tension = dp_.perimeter_spring != PerimeterSpring::along;
  InterfaceTerms interface;
  interface.line_tension = dp_.line_tension;
  // The deviations from the mean length add up to zero. So the derivative of the mean length does not
  // contribute to the force.
  interface.spring = has_tension ? *dp_.perimeter_stiffness * *dp_.vertices : 0;
  interface.spring_length =
      dp_.perimeter_spring == PerimeterSpring::rest ? rest_edge_ : perimeter / *dp_.vertices;
  interface.spreading = has_tension ? 0 : *dp_.perimeter_stiffness * *dp_.vertices;
  interface.pressure = -dp_.area_stiffness.value() * (area - rest_area_);
  interface.vertex_weight = dp_.gravity == Gravity::vertex ? weight_ / *dp_.vertices : 0;
  return interface;
}

WallYield DpForces::let_walls_yield(DropletState& state, WallTouches& touches,
                                    std::span<const WallContacts::Item> circles, Purpose purpose) const {
  if (friction_.is_on())
    return friction_.follow(state, touches.find(state, circles), purpose, touches.known_anchors());
  return wetted_walls_.follow(state, purpose);
}

template <class Visit>
void DpForces::visit_overlaps(const DropletState& state, Visit visit) const {
  const int n = *dp_.vertices;
  const auto vertex = [&](int i) { return Eigen::Array2d(state.position[i], state.position[n + i]); };
  const Eigen::ArrayXd fine = refined(state.position);
  const auto point = [&](int i) { return Eigen::Array2d(fine[i % (2 * n)], fine[2 * n + i % (2 * n)]); };
  for (const WallContacts::Item& item : walls_.items())
    for (unsigned bits = item.edges; bits != 0; bits &= bits - 1) {
      const int i = item.group * WallContacts::edges_per_group + std::countr_zero(bits);
      const Eigen::Array2d centre{item.x, item.y};
      if (dp_.wall_contact == WallContact::vertex) {
        visit(item.reach - (vertex(i) - centre).matrix().norm());
        continue;
      }
      visit(item.reach - distance_to_segment(centre, point(2 * i), point(2 * i + 1)));
      visit(item.reach - distance_to_segment(centre, point(2 * i + 1), point(2 * i + 2)));
    }
  for (const Wedge& wedge : obstacles_->wedges()) {
    const kernel::WedgePlace place = kernel::place_in(state.frame, wedge);
    for (int i = 0; i < n; ++i)
      visit(walls_.range() - distance_to(wedge, vertex(i) - Eigen::Array2d(place.x, place.y)).distance);
  }
}

double DpForces::deepest_overlap(const DropletState& state) const {
  double deepest = 0;
  visit_overlaps(state, [&](double overlap) { deepest = std::max(deepest, overlap); });
  return deepest;
}

double DpForces::self_contact_energy(const Contour& contour, const DropletState& state) const {
  SelfCrossings crossings;
  std::vector<SelfCrossing> crossed = state.crossings;
  crossings.rebuild(contour, crossed);
  double energy = contact_stiffness_ * crossings.find_pushes(contour, self_);
  for (const SelfContacts::Pair& pair : self_.pairs()) {
    if (crossings.is_muted(pair)) continue;
    const double overlap =
        std::max(0.0, self_.range() - nearest_point(pair, contour.x, contour.y, contour.size).distance);
    energy += 0.5 * contact_stiffness_ * overlap * overlap;
  }
  return energy;
}

PotentialEnergy DpForces::energy(const DropletState& state) const {
  const int n = *dp_.vertices;
  const double* x = state.position.data();
  const double* y = x + n;
  const PolygonShape shape = polygon_shape(state.position);
  PotentialEnergy energy;
  energy.area = 0.5 * dp_.area_stiffness.value() * (shape.area - rest_area_) * (shape.area - rest_area_);
  energy.line_tension = dp_.line_tension * shape.perimeter;
  const double height = dp_.gravity == Gravity::vertex ? state.x().mean() : area_centroid(state.position)[0];
  energy.gravity = -weight_ * height;

  const double reference = dp_.perimeter_spring == PerimeterSpring::rest ? rest_edge_ : shape.perimeter / n;
  for (int i = 0, j = n - 1; i < n; j = i++) {
    const double stretch = std::hypot(x[i] - x[j], y[i] - y[j]) - reference;
    if (dp_.perimeter_spring != PerimeterSpring::along)
      energy.spring += 0.5 * *dp_.perimeter_stiffness * n * stretch * stretch;
  }
  visit_overlaps(state, [&](double overlap) {
    if (overlap > 0) energy.wall += 0.5 * contact_stiffness_ * overlap * overlap;
  });
  if (dp_.self_contact == SelfContact::on) energy.self_contact = self_contact_energy({n, x, y}, state);
  energy.line_tension += wetted_walls_.tension_energy(state);
  energy.anchors = friction_.is_on() ? friction_.energy(state) : wetted_walls_.spring_energy(state);
  return energy;
}

}  // namespace clog

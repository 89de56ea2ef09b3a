#include "clog/core/polygon/dp_forces.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "clog/core/tools/units.hpp"
#include "dp_kernel.hpp"

namespace clog {

kernel::WedgePlace kernel::place_in(const LocalFrame& frame, const Wedge& wedge) {
  const Eigen::Array2d centre = wedge.centre() - frame.origin - frame.image.cast<double>() * frame.period;
  return {.x = centre[0],
          .y = centre[1],
          .radius = wedge.radius,
          .axis_x = wedge.axis[0],
          .axis_y = wedge.axis[1],
          .cos = wedge.half_angle.cos,
          .sin = wedge.half_angle.sin};
}

DpForces::DpForces(const RunParameters& run, const ObstacleArray& obstacles)
    : dp_(run.dp),
      obstacles_(&obstacles),
      vertex_diameter_(units::regular_edge_length(*run.dp.vertices)),
      contact_stiffness_(clog::contact_stiffness(run.wall_stiffness.value(), vertex_diameter_)),
      weight_(units::droplet_mass * units::gravity),
      near_wall_cutoff_(run.drag.near_wall_cutoff),
      walls_(obstacles, dp_.contact_range.value(),
             dp_.wall_contact == WallContact::edge ? WallContacts::Keep::touched_by_edge
                                                   : WallContacts::Keep::touched_by_vertex),
      nearest_walls_(obstacles, dp_.contact_range.value(), WallContacts::Keep::nearest_to_vertex),
      wetted_walls_(run, obstacles),
      self_(dp_.self_contact_range, vertex_diameter_),
      friction_(dp_.friction, dp_.yield_traction, friction_stiffness_ratio * contact_stiffness_,
                obstacles.wedges()),
      wetting_(*dp_.vertices),
      edge_x_(*dp_.vertices),
      edge_y_(*dp_.vertices),
      edge_length_(*dp_.vertices),
      pull_(*dp_.vertices),
      centroid_gradient_(Eigen::ArrayXd::Zero(Eigen::Index{4} * *dp_.vertices)),
      refined_edges_(8 * *dp_.vertices),
      wall_distance_(run.drag.near_wall > 0 ? *dp_.vertices : 0) {
  set_rest_area(units::rest_area);
}

void DpForces::set_rest_area(double area) {
  rest_area_ = area;
  rest_edge_ = units::regular_edge_length(*dp_.vertices, area);
  self_.set_rest_edge(rest_edge_);
}

void DpForces::update_contacts(const DropletState& state, const Travel& travel) {
  walls_.update(state, travel);
  if (wall_distance_.size() > 0) nearest_walls_.update(state, travel);
  if (wetted_walls_.is_on()) wetted_walls_.lists().update(state, travel);
  if (dp_.self_contact == SelfContact::on) self_.update(state, travel);
}

bool DpForces::contacts_hold(double moved, double moved_relative, const Travel& travel) const {
  if (wall_distance_.size() > 0 || wetted_walls_.is_on()) return false;
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

kernel::Interface DpForces::interface(double area, double perimeter) const {
  const bool has_tension = dp_.perimeter_spring != PerimeterSpring::along;
  kernel::Interface interface;
  interface.line_tension = dp_.line_tension;
  // The springs to the mean length are unloaded on average: their force needs no derivative of the mean.
  interface.spring = has_tension ? *dp_.perimeter_stiffness * *dp_.vertices : 0;
  interface.spring_length =
      dp_.perimeter_spring == PerimeterSpring::rest ? rest_edge_ : perimeter / *dp_.vertices;
  interface.spreading = has_tension ? 0 : *dp_.perimeter_stiffness * *dp_.vertices;
  interface.pressure = -dp_.area_stiffness.value() * (area - rest_area_);
  interface.vertex_weight = dp_.gravity == Gravity::vertex ? weight_ / *dp_.vertices : 0;
  return interface;
}

void DpForces::evaluate(const DropletState& state, Eigen::ArrayXd& force) {
  const int n = *dp_.vertices;
  const double* x = state.position.data();
  const double* y = x + n;
  double* fx = force.data();
  double* fy = fx + n;

  const kernel::EdgeArrays edges{edge_x_.data(), edge_y_.data(), edge_length_.data()};
  const kernel::Sums sums = kernel::measure_edges(n, x, y, edges);
  shape_ = {sums.area, sums.perimeter};
  kernel::interface_forces(n, interface(shape_.area, shape_.perimeter), edges, pull_.data(), fx, fy);
  Eigen::Array2d spread{force.head(n).sum(), force.tail(n).sum()};
  if (wetted_walls_.is_on()) {
    wetted_walls_.find_forces(VertexPlaces(state), state.frame, state.anchors, wetting_);
    force += wetting_.gradient + wetting_.spreading;
    spread += wetting_.net_spreading;
  }
  if (dp_.gravity == Gravity::area) {
    // Tension and pressure add up to nothing; springs along the interface have no reaction on their
    // neighbours, so they push off the liquid inside: the droplet as a whole feels no force from them.
    const kernel::CentroidGradient gradient = kernel::centroid_gradient(n, centroid_gradient_.data());
    kernel::measure_centroid_gradient(n, x, y, edges, sums, gradient);
    kernel::add_body_force(n, weight_ - spread[0], -spread[1], gradient, fx, fy);
  }

  add_walls(state, force);
  if (friction_.is_on()) friction_.add_forces(state, force);
  if (wall_distance_.size() > 0) measure_wall_distance(state);
  if (dp_.self_contact == SelfContact::on) add_self_contact(state, force);
}

void DpForces::add_walls(const DropletState& state, Eigen::ArrayXd& force) {
  const int n = *dp_.vertices;
  const double* x = state.position.data();
  const double* y = x + n;
  double* fx = force.data();
  double* fy = fx + n;
  const bool meets_edges = dp_.wall_contact == WallContact::edge;
  const kernel::RefinedEdges edges = kernel::refined_edges(n, refined_edges_.data());
  if (meets_edges) kernel::refine_edges(n, x, y, edges);
  if (meets_edges) {
    for (const WallContacts::Item& item : walls_.items()) {
      const int first = item.group * WallContacts::edges_per_group;
      kernel::push_off_circle(n, x, y, edges,
                              {item.x, item.y, item.reach, first, first + WallContacts::edges_per_group},
                              contact_stiffness_);
    }
    kernel::hand_out_pushes(n, edges, fx, fy);
  }
  for (int s = 0; s < walls_.num_slots(); ++s)
    kernel::add_vertex_wall_forces(n, x, y, {walls_.slot_x(s), walls_.slot_y(s), walls_.slot_radius(s)},
                                   walls_.range(), contact_stiffness_, fx, fy);
  for (const Wedge& wedge : obstacles_->wedges())
    kernel::add_wedge_forces(n, x, y, kernel::place_in(state.frame, wedge), walls_.range(),
                             contact_stiffness_, fx, fy);
}

void DpForces::measure_wall_distance(const DropletState& state) {
  const int n = *dp_.vertices;
  const double* x = state.position.data();
  const double* y = x + n;
  double* distance = wall_distance_.data();
  wall_distance_.setConstant(std::numeric_limits<double>::infinity());
  for (int s = 0; s < nearest_walls_.num_slots(); ++s)
    kernel::shrink_to_wall_distance(
        n, x, y, {nearest_walls_.slot_x(s), nearest_walls_.slot_y(s), nearest_walls_.slot_radius(s)},
        distance);
  for (const Wedge& wedge : obstacles_->wedges())
    kernel::shrink_to_wedge_distance(n, x, y, kernel::place_in(state.frame, wedge), distance);
  wall_distance_ = wall_distance_.max(near_wall_cutoff_);
}

WallYield DpForces::let_walls_yield(DropletState& state, WallTouches& touches,
                                    std::span<const WallContacts::Item> circles, Purpose purpose) const {
  if (friction_.is_on())
    return friction_.follow(state, touches.find(state, circles, self_), purpose, touches.known_anchors());
  return wetted_walls_.follow(state, purpose);
}

void DpForces::add_self_contact(const DropletState& state, Eigen::ArrayXd& force) const {
  const int n = *dp_.vertices;
  const double* x = state.position.data();
  const double* y = x + n;
  double* fx = force.data();
  double* fy = fx + n;
  for (const SelfContacts::Pair& pair : self_.pairs()) {
    const EdgeContact contact = nearest_point(pair, x, y, n);
    if (contact.distance >= self_.range() || contact.distance == 0) continue;
    const double push = contact_stiffness_ * (self_.range() - contact.distance) / contact.distance;
    const double px = push * contact.dx;
    const double py = push * contact.dy;
    const int end = pair.edge + 1 < n ? pair.edge + 1 : 0;
    fx[pair.vertex] += px;
    fy[pair.vertex] += py;
    fx[pair.edge] -= (1 - contact.fraction) * px;
    fy[pair.edge] -= (1 - contact.fraction) * py;
    fx[end] -= contact.fraction * px;
    fy[end] -= contact.fraction * py;
  }
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
  if (dp_.self_contact == SelfContact::on)
    for (const SelfContacts::Pair& pair : self_.pairs()) {
      const double overlap = std::max(0.0, self_.range() - nearest_point(pair, x, y, n).distance);
      energy.self_contact += 0.5 * contact_stiffness_ * overlap * overlap;
    }
  energy.line_tension += wetted_walls_.tension_energy(state);
  energy.anchors = friction_.is_on() ? friction_.energy(state) : wetted_walls_.spring_energy(state);
  return energy;
}

}  // namespace clog

#include "clog/core/dp_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "clog/core/units.hpp"
#include "dp_kernel.hpp"

namespace clog {

DpForces::DpForces(const RunParameters& run, const ObstacleArray& obstacles)
    : dp_(run.dp),
      vertex_diameter_(units::regular_edge_length(run.dp.vertices)),
      contact_stiffness_(contact_stiffness(run.wall_stiffness.value(), vertex_diameter_)),
      weight_(units::droplet_mass * units::gravity),
      walls_(obstacles, vertex_diameter_ / 2, WallContacts::Keep::touched_by_edge),
      nearest_walls_(obstacles, vertex_diameter_ / 2, WallContacts::Keep::nearest_to_vertex),
      self_(vertex_diameter_),
      edge_x_(dp_.vertices),
      edge_y_(dp_.vertices),
      edge_length_(dp_.vertices),
      pull_(dp_.vertices),
      end_x_(dp_.vertices),
      end_y_(dp_.vertices),
      wall_distance_(run.drag.near_wall > 0 ? dp_.vertices : 0) {
  set_rest_area(units::rest_area);
}

void DpForces::set_rest_area(double area) {
  rest_area_ = area;
  rest_edge_ = units::regular_edge_length(dp_.vertices, area);
}

void DpForces::update_contacts(const DropletState& state, const Travel& travel) {
  walls_.update(state, travel);
  if (wall_distance_.size() > 0) nearest_walls_.update(state, travel);
  if (dp_.self_contact == SelfContact::on)
    self_.update(state, travel, polygon_shape(state.position).perimeter / dp_.vertices);
}

void DpForces::forget_contacts() {
  walls_.invalidate();
  nearest_walls_.invalidate();
}

double DpForces::spring_length() const {
  return dp_.perimeter_spring == PerimeterSpring::rest ? rest_edge_ : shape_.perimeter / dp_.vertices;
}

void DpForces::evaluate(const DropletState& state, Eigen::ArrayXd& force) {
  const int n = dp_.vertices;
  const double* x = state.position.data();
  const double* y = x + n;
  double* fx = force.data();
  double* fy = fx + n;

  const kernel::EdgeArrays edges{edge_x_.data(), edge_y_.data(), edge_length_.data()};
  const kernel::Sums sums = kernel::measure_edges(n, x, y, edges);
  shape_ = {sums.area, sums.perimeter};
  const kernel::Interface interface {
    .line_tension = dp_.line_tension, .spring = *dp_.perimeter_stiffness * n,
    // The springs to the mean length are unloaded on average, so their force needs no derivative of the mean.
        .spring_length = spring_length(), .pressure = -dp_.area_stiffness * (shape_.area - rest_area_),
    .vertex_weight = dp_.gravity == Gravity::vertex ? weight_ / n : 0,
  };
  kernel::interface_forces(n, interface, edges, pull_.data(), fx, fy);
  if (dp_.gravity == Gravity::area) add_centroid_weight(state, force);

  for (int s = 0; s < walls_.num_slots(); ++s)
    kernel::add_wall_forces(n, x, y, edges, {walls_.slot_x(s), walls_.slot_y(s), walls_.slot_radius(s)},
                            walls_.range(), contact_stiffness_, end_x_.data(), end_y_.data(), fx, fy);
  if (wall_distance_.size() > 0) {
    wall_distance_.setConstant(std::numeric_limits<double>::infinity());
    for (int s = 0; s < nearest_walls_.num_slots(); ++s)
      kernel::shrink_to_wall_distance(
          n, x, y, {nearest_walls_.slot_x(s), nearest_walls_.slot_y(s), nearest_walls_.slot_radius(s)},
          wall_distance_.data());
    wall_distance_ = wall_distance_.max(vertex_diameter_ / 2);
  }
  if (dp_.self_contact == SelfContact::on) add_self_contact(state, force);
}

/// U = -M g X, X the x coordinate of the area centroid: X = S/a with S = (1/6) sum (x_i + x_{i+1}) c_i,
/// c_i = x_i y_{i+1} - x_{i+1} y_i, so grad X = (grad S - X grad a)/a.
void DpForces::add_centroid_weight(const DropletState& state, Eigen::ArrayXd& force) const {
  const Eigen::Index n = dp_.vertices;
  const Eigen::Array2d centre =
      state.centre();  // X is invariant under shifts; small coordinates keep it exact
  const auto x = [&](Eigen::Index i) { return state.position[i] - centre[0]; };
  const auto y = [&](Eigen::Index i) { return state.position[n + i] - centre[1]; };
  const auto cross = [&](Eigen::Index i, Eigen::Index j) { return x(i) * y(j) - x(j) * y(i); };
  double moment = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index next = i + 1 < n ? i + 1 : 0;
    moment += (x(i) + x(next)) * cross(i, next) / 6;
  }
  const double centroid = moment / shape_.area;
  const double scale = weight_ / shape_.area;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index next = i + 1 < n ? i + 1 : 0;
    const Eigen::Index before = i > 0 ? i - 1 : n - 1;
    const double moment_x =
        (cross(i, next) + (x(i) + x(next)) * y(next) + cross(before, i) - (x(before) + x(i)) * y(before)) / 6;
    const double moment_y = ((x(before) + x(i)) * x(before) - (x(i) + x(next)) * x(next)) / 6;
    const double area_x = 0.5 * (y(next) - y(before));
    const double area_y = 0.5 * (x(before) - x(next));
    force[i] += scale * (moment_x - centroid * area_x);
    force[n + i] += scale * (moment_y - centroid * area_y);
  }
}

void DpForces::add_self_contact(const DropletState& state, Eigen::ArrayXd& force) const {
  const int n = dp_.vertices;
  const double* x = state.position.data();
  const double* y = x + n;
  double* fx = force.data();
  double* fy = fx + n;
  for (const SelfContacts::Strand& strand : self_.strands()) {
    const StrandContact contact = nearest_point(strand, x, y, n);
    if (contact.distance >= self_.diameter() || contact.distance == 0) continue;
    const double push = contact_stiffness_ * (self_.diameter() - contact.distance) / contact.distance;
    const double px = push * contact.dx;
    const double py = push * contact.dy;
    const int begin = contact.edge;
    const int end = begin + 1 < n ? begin + 1 : 0;
    fx[strand.vertex] += px;
    fy[strand.vertex] += py;
    fx[begin] -= (1 - contact.fraction) * px;
    fy[begin] -= (1 - contact.fraction) * py;
    fx[end] -= contact.fraction * px;
    fy[end] -= contact.fraction * py;
  }
}

template <class Visit>
void DpForces::visit_overlaps(const DropletState& state, Visit visit) const {
  const int n = dp_.vertices;
  for (int s = 0; s < walls_.num_slots(); ++s)
    for (int i = 0; i < n; ++i) {
      const int next = i + 1 < n ? i + 1 : 0;
      const double distance = distance_to_segment({walls_.slot_x(s)[i], walls_.slot_y(s)[i]},
                                                  {state.position[i], state.position[n + i]},
                                                  {state.position[next], state.position[n + next]}) -
                              walls_.slot_radius(s)[i];
      visit(walls_.range() - distance);
    }
}

double DpForces::deepest_overlap(const DropletState& state) const {
  double deepest = 0;
  visit_overlaps(state, [&](double overlap) { deepest = std::max(deepest, overlap); });
  return deepest;
}

DpEnergy DpForces::energy(const DropletState& state) const {
  const int n = dp_.vertices;
  const double* x = state.position.data();
  const double* y = x + n;
  const PolygonShape shape = polygon_shape(state.position);
  DpEnergy energy;
  energy.area = 0.5 * dp_.area_stiffness * (shape.area - rest_area_) * (shape.area - rest_area_);
  energy.line_tension = dp_.line_tension * shape.perimeter;
  const double height = dp_.gravity == Gravity::vertex ? state.x().mean() : area_centroid(state.position)[0];
  energy.gravity = -weight_ * height;

  const double reference = dp_.perimeter_spring == PerimeterSpring::rest ? rest_edge_ : shape.perimeter / n;
  for (int i = 0, j = n - 1; i < n; j = i++) {
    const double stretch = std::hypot(x[i] - x[j], y[i] - y[j]) - reference;
    energy.spring += 0.5 * *dp_.perimeter_stiffness * n * stretch * stretch;
  }
  visit_overlaps(state, [&](double overlap) {
    if (overlap > 0) energy.wall += 0.5 * contact_stiffness_ * overlap * overlap;
  });
  if (dp_.self_contact == SelfContact::on)
    for (const SelfContacts::Strand& strand : self_.strands()) {
      const double overlap = std::max(0.0, self_.diameter() - nearest_point(strand, x, y, n).distance);
      energy.self_contact += 0.5 * contact_stiffness_ * overlap * overlap;
    }
  return energy;
}

}  // namespace clog

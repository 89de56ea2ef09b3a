#include "clog/core/polygon/wetting/wetted_walls.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

#include "clog/core/tools/units.hpp"
#include "core/polygon/contact/wedge_place.hpp"

namespace clog {
namespace {

/// The edge from vertex i to the next vertex.
Eigen::Array2d edge_of(const VertexPlaces& vertices, int i) {
  const int end = i + 1 < vertices.size ? i + 1 : 0;
  return {vertices.x[end] - vertices.x[i], vertices.y[end] - vertices.y[i]};
}

}  // namespace

WettedWalls::WettedWalls(const RunParameters& run, const ObstacleArray& obstacles)
    : extra_tension_((wall_tension(run.dp) - 1) * run.dp.line_tension),
      spreads_(run.dp.perimeter_spring == PerimeterSpring::along),
      contact_range_(run.dp.contact_range.value()),
      width_(wetting_width * units::regular_edge_length(*run.dp.vertices)),
      obstacles_(&obstacles),
      lists_(obstacles, contact_range_ + width_, WallContacts::Keep::touched_by_vertex),
      line_(run, obstacles.wedges()) {}

WettedWalls::Forces::Forces(int num_vertices)
    : gradient(Eigen::ArrayXd::Zero(Eigen::Index{2} * num_vertices)),
      spreading(gradient),
      of_vertices(static_cast<std::size_t>(num_vertices)) {}

/// Discards earlier results.
void WettedWalls::Forces::clear() {
  const Eigen::Index n = gradient.size() / 2;
  for (const int i : vertices) {
    gradient[i] = gradient[n + i] = spreading[i] = spreading[n + i] = 0;
    of_vertices[static_cast<std::size_t>(i)].is_listed = false;
  }
  vertices.clear();
  net_spreading = {0, 0};
  for (const int i : near) {
    of_vertices[static_cast<std::size_t>(i)].share = {0, 0};
    of_vertices[static_cast<std::size_t>(i)].is_near = false;
  }
  near.clear();
}

/// Fills the list of vertices, after all forces have been added.
void WettedWalls::Forces::list_vertices() {
  const auto n = static_cast<int>(of_vertices.size());
  const auto list = [this](int i) {
    bool& is_listed = of_vertices[static_cast<std::size_t>(i)].is_listed;
    if (!is_listed) vertices.push_back(i);
    is_listed = true;
  };
  for (const int i : near) {
    if (!(of_vertices[static_cast<std::size_t>(i)].share.share > 0)) continue;
    for (const int one : {i > 0 ? i - 1 : n - 1, i, i + 1 < n ? i + 1 : 0}) list(one);
  }
  for (const ContactLine::End& end : ends.all())
    for (const ContactLine::Gradient& gradient_of_end : ends.gradients(end))
      list(static_cast<int>(gradient_of_end.vertex));
}

/// Finds the wall next to each vertex that a wall may wet.
void WettedWalls::find_near(const VertexPlaces& vertices, const LocalFrame& frame, Forces& forces) const {
  const Eigen::Index n = vertices.size;
  const auto meet = [&](int i, double distance, const Eigen::Array2d& normal) {
    Forces::Vertex& vertex = forces.of_vertices[static_cast<std::size_t>(i)];
    if (!vertex.is_near) forces.near.push_back(i);
    if (vertex.is_near && distance >= vertex.distance) return;
    vertex.is_near = true;
    vertex.distance = distance;
    vertex.normal = normal;
  };
  for (const WallContacts::Item& item : lists_.items())
    for (unsigned bits = item.edges; bits != 0; bits &= bits - 1) {
      const int i = item.group * WallContacts::edges_per_group + std::countr_zero(bits);
      const Eigen::Array2d away{vertices.x[i] - item.x, vertices.y[i] - item.y};
      const double square = away.matrix().squaredNorm();
      if (square >= item.reach * item.reach) continue;  // the wall does not wet this vertex
      const double r = std::sqrt(square);
      meet(i, r - (item.reach - contact_range_ - width_), away / r);
    }
  for (const Wedge& wedge : obstacles_->wedges()) {
    const kernel::WedgePlace place = kernel::place_in(frame, wedge);
    for (int i = 0; i < n; ++i) {
      const auto [distance, normal] =
          distance_to(wedge, Eigen::Array2d(vertices.x[i] - place.x, vertices.y[i] - place.y));
      meet(i, distance, normal);
    }
  }
  for (const int i : forces.near) {
    Forces::Vertex& vertex = forces.of_vertices[static_cast<std::size_t>(i)];
    vertex.share = wetted_share(vertex.distance, contact_range_, width_);
  }
}

/// Adds the forces of U_gamma = sum gamma_e l_e. The tension gamma_e of an edge is Gamma + (Gamma_wall -
/// Gamma) times the mean share of the edge's two vertices. This is the energy of Cheng et al. Eq. 2, which
/// has three tensions; here the two tensions at a wetted wall are combined into one. On a smooth interface
/// the gradient of this energy has no component along the interface, because -d(gamma)/ds from the edges
/// cancels the pull towards the wall. On a polygon there is a component along the interface; it is an error
/// due to the finite edges.
void WettedWalls::add_tension(const VertexPlaces& vertices, Forces& forces) const {
  const auto n = static_cast<int>(vertices.size);
  const auto of = [&](int i) -> const Forces::Vertex& {
    return forces.of_vertices[static_cast<std::size_t>(i)];
  };
  const auto push = [&](int i, const Eigen::Array2d& force) {
    forces.gradient[i] += force[0];
    forces.gradient[n + i] += force[1];
  };
  const auto pull_together = [&](int first, int second, const Eigen::Array2d& edge, double length) {
    const Eigen::Array2d pull =
        extra_tension_ * (of(first).share.share + of(second).share.share) / 2 / length * edge;
    push(first, pull);
    push(second, -pull);
  };
  for (const int i : forces.near) {
    if (!(of(i).share.share > 0)) continue;
    const int before = i > 0 ? i - 1 : n - 1, after = i + 1 < n ? i + 1 : 0;
    const Eigen::Array2d edge_before = edge_of(vertices, before), edge_after = edge_of(vertices, i);
    const double length_before = edge_before.matrix().norm(), length_after = edge_after.matrix().norm();
    push(i, -extra_tension_ * of(i).share.slope * (length_before + length_after) / 2 * of(i).normal);
    pull_together(before, i, edge_before, length_before);
    // If the share of the vertex `after` is positive, the loop adds this edge when it reaches `after`.
    if (!(of(after).share.share > 0)) pull_together(i, after, edge_after, length_after);
  }
}

void WettedWalls::spread(const VertexPlaces& vertices, Forces& forces) const {
  const auto n = static_cast<int>(vertices.size);
  for (const int i : forces.vertices) {
    const Eigen::Array2d chord = edge_of(vertices, i) + edge_of(vertices, i > 0 ? i - 1 : n - 1);
    const Eigen::Array2d here{forces.gradient[i], forces.gradient[n + i]};
    const Eigen::Array2d along = (here * chord).sum() / chord.square().sum() * chord;
    forces.spreading[i] = -along[0];
    forces.spreading[n + i] = -along[1];
    forces.net_spreading -= along;
  }
}

void WettedWalls::find_forces(const VertexPlaces& vertices, const LocalFrame& frame,
                              std::span<const WallAnchor> anchors, Forces& forces) const {
  if (line_.is_on()) line_.find_ends(vertices, frame, lists_.items(), forces.ends);
  add_up(vertices, frame, anchors, forces);
}

WallYield WettedWalls::follow_and_find_forces(const VertexPlaces& vertices, const LocalFrame& frame,
                                              std::vector<WallAnchor>& anchors, Forces& forces) const {
  WallYield yield;
  if (line_.is_on()) {
    line_.find_ends(vertices, frame, lists_.items(), forces.ends);
    yield = line_.follow(anchors, forces.ends, Purpose::motion);
  }
  add_up(vertices, frame, anchors, forces);
  return yield;
}

void WettedWalls::add_up(const VertexPlaces& vertices, const LocalFrame& frame,
                         std::span<const WallAnchor> anchors, Forces& forces) const {
  assert(forces.gradient.size() == 2 * vertices.size);
  forces.clear();
  if (extra_tension_ != 0) {
    find_near(vertices, frame, forces);
    add_tension(vertices, forces);
  }
  if (line_.is_on()) line_.add_forces(anchors, forces.ends, forces.gradient);
  forces.list_vertices();
  if (spreads_) spread(vertices, forces);
}

WallYield WettedWalls::follow(DropletState& state, Purpose purpose) const {
  ContactLine::Ends ends;
  line_.find_ends(VertexPlaces(state), state.frame, lists_.items(), ends);
  return line_.follow(state.anchors, ends, purpose);
}

double WettedWalls::tension_energy(const DropletState& state) const {
  if (extra_tension_ == 0) return 0;
  const VertexPlaces vertices(state);
  Forces forces(static_cast<int>(state.size()));
  find_near(vertices, state.frame, forces);
  double energy = 0;
  for (int i = 0, j = static_cast<int>(state.size()) - 1; i < state.size(); j = i++) {
    const double shares = forces.of_vertices[static_cast<std::size_t>(i)].share.share +
                          forces.of_vertices[static_cast<std::size_t>(j)].share.share;
    energy += extra_tension_ * shares / 2 * edge_of(vertices, j).matrix().norm();
  }
  return energy;
}

double WettedWalls::spring_energy(const DropletState& state) const {
  if (!line_.is_on()) return 0;
  ContactLine::Ends ends;
  line_.find_ends(VertexPlaces(state), state.frame, lists_.items(), ends);
  return line_.energy(state.anchors, ends);
}

}  // namespace clog

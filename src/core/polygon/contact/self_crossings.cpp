#include "clog/core/polygon/contact/self_crossings.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

namespace clog {
namespace {

/// Number of edges on each side of a crossing's edge to which the vertex may have slid in a step. Edges
/// farther along the contour, or behind a sharp corner, may belong to the other side of a finger.
constexpr int beside = 2;
/// Number of edges on each side of a crossing's edge that the vertex's own edges may cross.
constexpr int far = 8;

double cross_product(const Eigen::Array2d& a, const Eigen::Array2d& b) { return a[0] * b[1] - a[1] * b[0]; }

/// Whether the vertex passed through the edge during the drift. All vertices moved in straight lines, so the
/// area of the triangle of vertex and edge is a quadratic function of time. The vertex is on the edge's line
/// where this area vanishes.
bool passes_through(const SelfContacts::Pair& pair, const Contour& contour,
                    const SelfCrossings::Drift& drift) {
  const int end = pair.edge + 1 < contour.size ? pair.edge + 1 : 0;
  const auto moved = [&](int vertex) -> Eigen::Array2d {
    return drift.time * Eigen::Array2d(drift.velocity_x[vertex], drift.velocity_y[vertex]);
  };
  const Eigen::Array2d edge_after = contour.place(end) - contour.place(pair.edge);
  const Eigen::Array2d way_after = contour.place(pair.vertex) - contour.place(pair.edge);
  const Eigen::Array2d edge_change = moved(end) - moved(pair.edge);
  const Eigen::Array2d way_change = moved(pair.vertex) - moved(pair.edge);
  const Eigen::Array2d edge = edge_after - edge_change, way = way_after - way_change;
  const double before = cross_product(edge, way), after = cross_product(edge_after, way_after);
  if ((before > 0) == (after > 0)) return false;
  // The root of before + linear * t + square * t^2 between 0 and 1, by a formula without cancellation.
  const double square = cross_product(edge_change, way_change), linear = after - before - square;
  const double root = std::sqrt(std::max(0.0, linear * linear - 4 * square * before));
  const double sum = linear + std::copysign(root, linear);
  const double one = sum != 0 ? -2 * before / sum : 0, other = square != 0 ? -sum / (2 * square) : one;
  const auto distance_from_step = [](double t) { return std::abs(t - std::clamp(t, 0.0, 1.0)); };
  const double time = distance_from_step(one) <= distance_from_step(other) ? one : other;
  const Eigen::Array2d edge_then = edge + time * edge_change, way_then = way + time * way_change;
  const double along = (way_then * edge_then).sum();
  return along >= 0 && along < edge_then.square().sum();
}

bool are_neighbours(const SelfContacts& contacts, const SelfContacts::Pair& pair, int num_vertices) {
  return contacts.are_neighbours(pair.vertex, pair.edge) ||
         contacts.are_neighbours(pair.vertex, (pair.edge + 1) % num_vertices);
}

/// A vertex and an edge that are neighbours along the contour repel each other only after the vertex has
/// passed through the edge.
double range_of(const SelfContacts& contacts, const SelfContacts::Pair& pair, int num_vertices) {
  return are_neighbours(contacts, pair, num_vertices) ? 0 : contacts.range();
}

/// The edge next to `edge` in this direction (1 or -1), if a vertex can slide onto it. @param bends  whether
/// the edges continue beyond corners of more than 90 degrees
std::optional<int> next_edge(const Contour& contour, Eigen::Index vertex, int edge, int step, bool bends) {
  const int n = contour.size, next = (edge + step + n) % n;
  if (next == vertex || (next + 1) % n == vertex) return std::nullopt;
  const auto along = [&](int one) -> Eigen::Array2d {
    return contour.place((one + 1) % n) - contour.place(one);
  };
  if (!bends && (along(edge) * along(next)).sum() < 0) return std::nullopt;
  return next;
}

/// Whether two pieces of the contour cross each other.
bool cross_each_other(const Contour& contour, const std::array<int, 2>& one,
                      const std::array<int, 2>& other) {
  const auto separates = [&](const std::array<int, 2>& line, const std::array<int, 2>& ends) {
    const Eigen::Array2d begin = contour.place(line[0]), way = contour.place(line[1]) - begin;
    return (cross_product(way, contour.place(ends[0]) - begin) > 0) !=
           (cross_product(way, contour.place(ends[1]) - begin) > 0);
  };
  return separates(one, other) && separates(other, one);
}

}  // namespace

bool SelfCrossings::is_muted(const SelfContacts::Pair& pair) const {
  return std::ranges::any_of(
      muted_, [&](const Muted& one) { return one.pair.vertex == pair.vertex && one.pair.edge == pair.edge; });
}

/// Fills chain_ with the crossing's edge and up to `most` edges on each side of it. @param bends  see
/// next_edge()
void SelfCrossings::find_chain(const Contour& contour, const SelfCrossing& crossing, int most, bool bends) {
  const auto edge = static_cast<int>(crossing.edge);
  chain_.assign(1, edge);
  for (const int step : {1, -1}) {
    std::optional<int> next = next_edge(contour, crossing.vertex, edge, step, bends);
    for (int k = 0; next && k < most; ++k) {
      chain_.push_back(*next);
      next = next_edge(contour, crossing.vertex, *next, step, bends);
    }
  }
}

/// The vertex at which the edges end in this direction; -1 if they continue for `far` edges.
int SelfCrossings::end_of_edges(const Contour& contour, const SelfCrossing& crossing, int step) {
  auto edge = static_cast<int>(crossing.edge);
  for (int k = 0; k < far; ++k) {
    const std::optional<int> next = next_edge(contour, crossing.vertex, edge, step, false);
    if (!next) return step > 0 ? (edge + 1) % contour.size : edge;
    edge = *next;
  }
  return -1;
}

/// Finds whether and how the interface still crosses itself at this crossing. The vertex and the neighbours
/// that have passed through with it form a chain. The edges at both ends of the chain cross the crossing's
/// edges.
CrossingPlace SelfCrossings::look_at(const Contour& contour, const SelfCrossing& crossing,
                                     const std::vector<SelfCrossing>& all) {
  const int n = contour.size;
  const auto is_crossed = [&](int vertex) {
    return std::ranges::any_of(all, [&](const SelfCrossing& one) { return one.vertex == vertex; });
  };
  find_chain(contour, crossing, far, true);
  const auto own_edge = [&](int step) -> CrossingPlace::OwnEdge {
    auto last = static_cast<int>(crossing.vertex);
    while (is_crossed((last + step) % n) && (last + step) % n != crossing.vertex) last = (last + step) % n;
    const int next = (last + step) % n;
    const bool crosses = std::ranges::any_of(chain_, [&](int edge) {
      const int end = (edge + 1) % n;
      return edge != last && end != last && edge != next && end != next &&
             cross_each_other(contour, {edge, end}, {last, next});
    });
    return {last, next, crosses};
  };
  return {.vertex = static_cast<int>(crossing.vertex),
          .edge = static_cast<int>(crossing.edge),
          .ends = {end_of_edges(contour, crossing, 1), end_of_edges(contour, crossing, -1)},
          .own = {own_edge(1), own_edge(n - 1)}};
}

/// Whether the vertex has passed back through the interface. If not, sets the crossing's edge to the edge
/// nearest to the vertex, among the present edge and its neighbours.
bool SelfCrossings::heals(const Contour& contour, const Drift& drift, SelfCrossing& crossing) {
  const auto vertex = static_cast<int>(crossing.vertex);
  find_chain(contour, crossing, beside, false);
  const auto num_passed = std::ranges::count_if(chain_, [&](int edge) {
    return passes_through({vertex, edge}, contour, drift);
  });
  if (num_passed % 2 != 0) return true;
  const auto distance = [&](int edge) {
    return nearest_point({vertex, edge}, contour.x, contour.y, contour.size).distance;
  };
  crossing.edge = *std::ranges::min_element(chain_, {}, distance);
  return false;
}

void SelfCrossings::rebuild(const Contour& contour, std::vector<SelfCrossing>& crossings) {
  places_.clear();
  muted_.clear();
  if (crossings.empty()) return;
  const int n = contour.size;
  const std::vector<SelfCrossing> all = crossings;
  crossings.clear();
  for (const SelfCrossing& crossing : all) {
    const CrossingPlace place = look_at(contour, crossing, all);
    if (!place.own[0].crosses && !place.own[1].crosses) continue;
    const int vertex = place.vertex, number = static_cast<int>(places_.size());
    find_chain(contour, crossing, beside, false);
    for (const int edge : chain_) {
      muted_.push_back({{vertex, edge}, number});
      for (const int end : {edge, (edge + 1) % n})
        for (const int own : {vertex, (vertex + n - 1) % n}) muted_.push_back({{end, own}, number});
    }
    places_.push_back(place);
    crossings.push_back(crossing);
  }
  const auto pair = [](const Muted& one) { return std::pair(one.pair.vertex, one.pair.edge); };
  std::ranges::stable_sort(muted_, {}, pair);
  const auto are_one = [&](const Muted& one, const Muted& other) { return pair(one) == pair(other); };
  muted_.erase(std::unique(muted_.begin(), muted_.end(), are_one), muted_.end());
}

bool SelfCrossings::follow(const Contour& contour, const Drift& drift, const SelfContacts& contacts,
                           DropletState& state) {
  assert(contour.size == state.size());
  std::vector<SelfContacts::Pair> passed;
  const auto add_if_passed = [&](const SelfContacts::Pair& pair) {
    if (!is_muted(pair) && passes_through(pair, contour, drift)) passed.push_back(pair);
  };
  for (const SelfContacts::Pair& pair : contacts.pairs()) add_if_passed(pair);
  // Vertices that are close along the contour are not listed, but may pass through each other's edges in a
  // sharp fold.
  const int n = contour.size, exclusion = contacts.exclusion();
  for (int vertex = 0; vertex < n; ++vertex)
    for (int apart = 1; apart < exclusion; ++apart)
      for (const int edge : {(vertex + apart) % n, (vertex + n - 1 - apart) % n})
        if (are_neighbours(contacts, {vertex, edge}, n)) add_if_passed({vertex, edge});
  if (passed.empty() && state.crossings.empty()) return false;
  const auto num_healed =
      std::erase_if(state.crossings, [&](SelfCrossing& one) { return heals(contour, drift, one); });
  state.num_healed += static_cast<std::int64_t>(num_healed);
  for (const SelfContacts::Pair& pair : passed) state.crossings.push_back({pair.vertex, pair.edge});
  // The muted contacts are those near the crossing's edge, which may have changed.
  rebuild(contour, state.crossings);
  return true;
}

double SelfCrossings::find_pushes(const Contour& contour, const SelfContacts& contacts) {
  pushes_.clear();
  depths_.clear();
  double energy = 0;
  for (const CrossingPlace& place : places_) {
    const CrossingDepth depth(contour, place);
    const double range = range_of(contacts, {place.vertex, place.edge}, contour.size);
    energy += (range + depth.size() / 2) * depth.size();
    depth.add_gradient(-range - depth.size(), pushes_);
    depths_.push_back(depth);
  }
  for (const Muted& muted : muted_)
    if (!are_neighbours(contacts, muted.pair, contour.size))
      energy += push_off(contour, muted, contacts.range());
  return energy;
}

/// The crossing that shifts this vertex in the contacts that `crossing` mutes; null if there is none. The
/// vertex may be a neighbour of the crossed vertex that has passed through nearby edges, too.
const CrossingDepth* SelfCrossings::depth_of(int vertex, int crossing, int num_vertices) const {
  const CrossingPlace& muting = places_[crossing];
  if (vertex == muting.vertex) return &depths_[crossing];
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const int apart = std::abs(places_[k].edge - muting.edge);
    if (places_[k].vertex == vertex && std::min(apart, num_vertices - apart) <= beside) return &depths_[k];
  }
  return nullptr;
}

/// Adds the pushes of a muted contact, computed as if crossed vertices were at the places that they would
/// have without the crossing. Returns the contact's energy.
double SelfCrossings::push_off(const Contour& contour, const Muted& muted, double range) {
  const std::array<int, 3> vertices = {muted.pair.vertex, muted.pair.edge,
                                       (muted.pair.edge + 1) % contour.size};
  std::array<const CrossingDepth*, 3> depths{};
  std::array<Eigen::Array2d, 3> places;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    depths[k] = depth_of(vertices[k], muted.crossing, contour.size);
    places[k] = contour.place(vertices[k]);
    if (depths[k] != nullptr) places[k] += depths[k]->shift();
  }
  const Eigen::Array2d edge = places[2] - places[1], to_vertex = places[0] - places[1];
  const double length2 = edge.square().sum();
  const double fraction = length2 > 0 ? std::clamp((to_vertex * edge).sum() / length2, 0.0, 1.0) : 0;
  const Eigen::Array2d away = to_vertex - fraction * edge;
  const double distance = away.matrix().norm(), overlap = range - distance;
  if (overlap <= 0) return 0;
  constexpr double round_off = 1e-9;
  if (distance > round_off * range) {  // otherwise the push has no direction
    const std::array<double, 3> shares = {1, fraction - 1, -fraction};
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      const Eigen::Array2d force = shares[k] * overlap / distance * away;
      pushes_.push_back({vertices[k], force});
      if (depths[k] != nullptr) depths[k]->add_gradient_of_shift(force, pushes_);
    }
  }
  return overlap * overlap / 2;
}

}  // namespace clog

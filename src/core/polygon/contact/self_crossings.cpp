#include "clog/core/polygon/contact/self_crossings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace clog {
namespace {

/// Number of edges on each side of a crossing's edge to which the vertex may have slid in a step. Edges
/// further along the contour, or behind a sharp corner, may belong to the other side of a finger.
constexpr int beside = 2;

double cross(const Eigen::Array2d& a, const Eigen::Array2d& b) { return a[0] * b[1] - a[1] * b[0]; }

Eigen::Array2d place(const Contour& contour, int vertex) { return {contour.x[vertex], contour.y[vertex]}; }

SelfContacts::Pair pair_of(const SelfCrossing& crossing) {
  return {static_cast<int>(crossing.vertex), static_cast<int>(crossing.edge)};
}

/// Whether the vertex passed through the edge during the drift. All vertices moved in straight lines, so the
/// area that vertex and edge span is a quadratic function of time; the vertex is on the edge's line where
/// this area vanishes.
bool passes_through(const SelfContacts::Pair& pair, const Contour& contour,
                    const SelfCrossings::Drift& drift) {
  const int end = pair.edge + 1 < contour.size ? pair.edge + 1 : 0;
  const auto moved = [&](int vertex) -> Eigen::Array2d {
    return drift.time * Eigen::Array2d(drift.velocity_x[vertex], drift.velocity_y[vertex]);
  };
  const Eigen::Array2d edge_after = place(contour, end) - place(contour, pair.edge);
  const Eigen::Array2d way_after = place(contour, pair.vertex) - place(contour, pair.edge);
  const Eigen::Array2d edge_change = moved(end) - moved(pair.edge);
  const Eigen::Array2d way_change = moved(pair.vertex) - moved(pair.edge);
  const Eigen::Array2d edge = edge_after - edge_change, way = way_after - way_change;
  const double before = cross(edge, way), after = cross(edge_after, way_after);
  if ((before > 0) == (after > 0)) return false;
  // The root of before + linear t + square t^2 between 0 and 1, in the form that does not cancel.
  const double square = cross(edge_change, way_change), linear = after - before - square;
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

/// Neighbours along the contour do not repel each other before the vertex has passed through the edge.
double range_of(const SelfContacts& contacts, const SelfContacts::Pair& pair, int num_vertices) {
  return are_neighbours(contacts, pair, num_vertices) ? 0 : contacts.range();
}

}  // namespace

bool SelfCrossings::is_muted(const SelfContacts::Pair& pair) const {
  return std::ranges::any_of(muted_, [&](const SelfContacts::Pair& one) {
    return one.vertex == pair.vertex && one.edge == pair.edge;
  });
}

/// Fills chain_ with the crossing's edge and up to `most` edges on each side of it. @param bends  whether the
/// chain continues beyond corners of more than 90 degrees
void SelfCrossings::find_chain(const Contour& contour, const SelfCrossing& crossing, int most, bool bends) {
  const int n = contour.size;
  const auto turns_back = [&](int one, int other) {
    return ((place(contour, (one + 1) % n) - place(contour, one)) *
            (place(contour, (other + 1) % n) - place(contour, other)))
               .sum() < 0;
  };
  const auto is_own = [&](int edge) { return edge == crossing.vertex || (edge + 1) % n == crossing.vertex; };
  chain_.clear();
  const auto edge = static_cast<int>(crossing.edge);
  chain_.push_back(edge);
  for (const int step : {1, n - 1})
    for (int k = 1, last = edge; k <= most; ++k) {
      const int next = (last + step) % n;
      if (is_own(next) || (!bends && turns_back(last, next))) break;
      chain_.push_back(last = next);
    }
}

/// Whether the interface still crosses itself here. Neighbours that have passed through, too, form a run; the
/// edges at both ends of the run then cross the chain.
bool SelfCrossings::is_real(const Contour& contour, const SelfCrossing& crossing,
                            const std::vector<SelfCrossing>& all) {
  constexpr int far = 8;  // edges of the chain
  const int n = contour.size;
  const auto is_crossed = [&](int vertex) {
    return std::ranges::any_of(all, [&](const SelfCrossing& one) { return one.vertex == vertex; });
  };
  find_chain(contour, crossing, far, true);
  const auto separates = [&](int begin, int end, int one, int other) {
    const Eigen::Array2d edge = place(contour, end) - place(contour, begin);
    return (cross(edge, place(contour, one) - place(contour, begin)) > 0) !=
           (cross(edge, place(contour, other) - place(contour, begin)) > 0);
  };
  for (const int step : {1, n - 1}) {
    auto last = static_cast<int>(crossing.vertex);
    while (is_crossed((last + step) % n) && (last + step) % n != crossing.vertex) last = (last + step) % n;
    const int next = (last + step) % n;
    for (const int edge : chain_) {
      const int end = (edge + 1) % n;
      if (edge == last || end == last || edge == next || end == next) continue;
      if (separates(edge, end, last, next) && separates(last, next, edge, end)) return true;
    }
  }
  return false;
}

/// Whether the vertex has passed back. Otherwise sets the crossing's edge to the nearest one of its
/// neighbours.
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
  if (!chain_.empty()) crossing.edge = *std::ranges::min_element(chain_, {}, distance);
  return false;
}

void SelfCrossings::renew(const Contour& contour, std::vector<SelfCrossing>& crossings) {
  muted_.clear();
  const int n = contour.size;
  const std::vector<SelfCrossing> all = crossings;
  std::erase_if(crossings, [&](const SelfCrossing& crossing) {
    if (!is_real(contour, crossing, all)) return true;
    find_chain(contour, crossing, beside, false);
    const auto vertex = static_cast<int>(crossing.vertex);
    for (const int edge : chain_) {
      muted_.push_back({vertex, edge});
      for (const int end : {edge, (edge + 1) % n})
        for (const int own : {vertex, (vertex + n - 1) % n}) muted_.push_back({end, own});
    }
    return false;
  });
}

bool SelfCrossings::follow(const Contour& contour, const Drift& drift, const SelfContacts& contacts,
                           DropletState& state) {
  std::vector<SelfContacts::Pair> passed;
  const auto add_if_passed = [&](const SelfContacts::Pair& pair) {
    if (!is_muted(pair) && passes_through(pair, contour, drift)) passed.push_back(pair);
  };
  for (const SelfContacts::Pair& pair : contacts.pairs()) add_if_passed(pair);
  // Vertices close along the contour are not listed, but may pass through each other's edges in a sharp fold.
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
  // Muted contacts move with the nearest edge.
  renew(contour, state.crossings);
  return true;
}

SelfCrossings::Push SelfCrossings::push_back(const SelfCrossing& crossing, const Contour& contour,
                                             const SelfContacts& contacts) {
  const SelfContacts::Pair pair = pair_of(crossing);
  const EdgeContact nearest = nearest_point(pair, contour.x, contour.y, contour.size);
  Eigen::Array2d direction{-nearest.dx, -nearest.dy};
  if (nearest.distance > 0) direction /= nearest.distance;
  return {crossing.vertex, crossing.edge,
          (range_of(contacts, pair, contour.size) + nearest.distance) * direction, nearest.fraction};
}

double SelfCrossings::energy(const SelfCrossing& crossing, const Contour& contour,
                             const SelfContacts& contacts) {
  const SelfContacts::Pair pair = pair_of(crossing);
  const double reach = range_of(contacts, pair, contour.size) +
                       nearest_point(pair, contour.x, contour.y, contour.size).distance;
  return reach * reach / 2;
}

}  // namespace clog

#include "clog/core/polygon/contact/self_crossings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace clog {
namespace {

/// Number of edges on each side of a crossing's edge to which the vertex may have slid in a step. Edges
/// further along the contour, or behind a sharp corner, may belong to the other side of a finger.
constexpr int beside = 2;
/// Number of edges on each side of a crossing's edge that the vertex's own edges may cross.
constexpr int far = 8;

double cross(const Eigen::Array2d& a, const Eigen::Array2d& b) { return a[0] * b[1] - a[1] * b[0]; }

Eigen::Array2d place(const Contour& contour, int vertex) { return {contour.x[vertex], contour.y[vertex]}; }

SelfContacts::Pair pair_of(const SelfCrossing& crossing) {
  return {static_cast<int>(crossing.vertex), static_cast<int>(crossing.edge)};
}

/// `v` turned by 90 degrees to the left.
Eigen::Array2d turned(const Eigen::Array2d& v) { return {-v[1], v[0]}; }

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

/// The edge after `edge` in this direction, 1 or -1, if a vertex can slide on to it. @param bends  whether
/// the edges continue beyond corners of more than 90 degrees
std::optional<int> next_edge(const Contour& contour, Eigen::Index vertex, int edge, int step, bool bends) {
  const int n = contour.size, next = (edge + step + n) % n;
  if (next == vertex || (next + 1) % n == vertex) return std::nullopt;
  const auto along = [&](int one) -> Eigen::Array2d {
    return place(contour, (one + 1) % n) - place(contour, one);
  };
  if (!bends && (along(edge) * along(next)).sum() < 0) return std::nullopt;
  return next;
}

/// Whether two pieces of the contour cross each other.
bool cross_each_other(const Contour& contour, const std::array<int, 2>& one,
                      const std::array<int, 2>& other) {
  const auto separates = [&](const std::array<int, 2>& line, const std::array<int, 2>& ends) {
    const Eigen::Array2d begin = place(contour, line[0]), way = place(contour, line[1]) - begin;
    return (cross(way, place(contour, ends[0]) - begin) > 0) !=
           (cross(way, place(contour, ends[1]) - begin) > 0);
  };
  return separates(one, other) && separates(other, one);
}

}  // namespace

/// How far a crossed vertex is behind the interface, and where it would be without the crossing.
class SelfCrossings::Depth {
 public:
  Depth(const Contour& contour, const Known& known)
      : vertex_(static_cast<int>(known.crossing.vertex)),
        begin_(static_cast<int>(known.crossing.edge)),
        end_((begin_ + 1) % contour.size) {
    const Eigen::Array2d from = place(contour, begin_), way = place(contour, end_) - from;
    length_ = way.matrix().norm();
    tangent_ = way / length_;
    const Eigen::Array2d to_vertex = place(contour, vertex_) - from;
    const double along = (to_vertex * tangent_).sum() / length_;
    fraction_ = std::clamp(along, 0.0, 1.0);
    is_beside_ = fraction_ == along;
    to_edge_ = fraction_ * way - to_vertex;
    distance_ = to_edge_.matrix().norm();
    for (const int end : known.ends)
      if (end >= 0) limit_by(contour, end, known.own);
  }

  int vertex() const { return vertex_; }
  double size() const { return is_limited() ? slip_.distance : distance_; }
  /// Moves the vertex to where muted contacts find it.
  Eigen::Array2d shift() const { return is_limited() ? slip_.distance / distance_ * to_edge_ : to_edge_; }

  /// Adds `factor` times the derivative of size().
  template <class Add>
  void add_derivative(double factor, Add add) const {
    is_limited() ? add_derivative_of_slip(factor, add) : add_derivative_of_distance(factor, add);
  }
  /// Adds the sum of the derivatives of the components of shift(), multiplied by those of `factor`.
  template <class Add>
  void add_derivative_of_shift(const Eigen::Array2d& factor, Add add) const {
    if (!is_limited()) {
      add_derivative_to_edge(factor, add);
      return;
    }
    const double share = slip_.distance / distance_, part = (factor * to_edge_).sum() / distance_;
    add_derivative_to_edge(share * factor, add);
    add_derivative_of_slip(part, add);
    add_derivative_of_distance(-part * share, add);
  }

 private:
  /// Distance of the end of the edges from an own edge of the vertex that crosses them.
  struct Slip {
    double distance = std::numeric_limits<double>::infinity();
    int end = 0, own_begin = 0, own_end = 0;
    double fraction = 0;
    Eigen::Array2d direction{0, 0};
  };
  int vertex_, begin_, end_;
  double length_, fraction_, distance_;
  Eigen::Array2d tangent_, to_edge_;
  bool is_beside_;
  Slip slip_;

  bool is_limited() const { return slip_.distance < distance_; }

  /// The vertex comes out at this end when both of its own edges have slipped off.
  void limit_by(const Contour& contour, int end, const std::array<OwnEdge, 2>& own) {
    Slip last{.distance = 0};
    for (const OwnEdge& edge : own) {
      if (!edge.crosses) continue;
      const Eigen::Array2d from = place(contour, edge.begin), way = place(contour, edge.end) - from;
      const Eigen::Array2d to_end = place(contour, end) - from, normal = turned(way) / way.matrix().norm();
      const double off = (to_end * normal).sum();
      if (std::abs(off) > last.distance)
        last = {std::abs(off),
                end,
                edge.begin,
                edge.end,
                (to_end * way).sum() / way.square().sum(),
                off > 0 ? normal : -normal};
    }
    if (last.distance < slip_.distance) slip_ = last;
  }

  template <class Add>
  void add_derivative_of_slip(double factor, Add add) const {
    add(slip_.end, factor * slip_.direction);
    add(slip_.own_begin, (slip_.fraction - 1) * factor * slip_.direction);
    add(slip_.own_end, -slip_.fraction * factor * slip_.direction);
  }
  template <class Add>
  void add_derivative_of_distance(double factor, Add add) const {
    if (distance_ == 0) return;
    const Eigen::Array2d outward = -factor / distance_ * to_edge_;
    add(vertex_, outward);
    add(begin_, (fraction_ - 1) * outward);
    add(end_, -fraction_ * outward);
  }
  /// Of the vector from the vertex to the nearest point of the edge.
  template <class Add>
  void add_derivative_to_edge(const Eigen::Array2d& factor, Add add) const {
    add(vertex_, -factor);
    if (!is_beside_) {
      add(fraction_ > 0 ? end_ : begin_, factor);
      return;
    }
    const Eigen::Array2d normal = turned(tangent_);
    const double along = (factor * tangent_).sum(), across = (factor * normal).sum();
    const double height = -(to_edge_ * normal).sum();
    const double on_end = fraction_ * across + along * height / length_;
    add(vertex_, along * tangent_);
    add(begin_, (across - on_end) * normal);
    add(end_, on_end * normal);
  }
};

/// A muted contact, with the crossed vertex where it would be without the crossing.
struct SelfCrossings::Contact {
  std::array<int, 3> points{};  // vertex, begin and end of the edge
  double overlap = 0;           // by which the contact is nearer than the range
  double fraction = 0;
  Eigen::Array2d direction{0, 0};  // from the edge to the vertex
};

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

/// The vertex at which the edges end in this direction, -1 if they go on for `far` edges.
int SelfCrossings::end_of_edges(const Contour& contour, const SelfCrossing& crossing, int step) {
  auto edge = static_cast<int>(crossing.edge);
  for (int k = 0; k < far; ++k) {
    const std::optional<int> next = next_edge(contour, crossing.vertex, edge, step, false);
    if (!next) return step > 0 ? (edge + 1) % contour.size : edge;
    edge = *next;
  }
  return -1;
}

/// Finds whether and how the interface still crosses itself here. Neighbours that have passed through, too,
/// form a run; the edges at both ends of the run then cross the crossing's edges.
SelfCrossings::Known SelfCrossings::look_at(const Contour& contour, const SelfCrossing& crossing,
                                            const std::vector<SelfCrossing>& all) {
  const int n = contour.size;
  const auto is_crossed = [&](int vertex) {
    return std::ranges::any_of(all, [&](const SelfCrossing& one) { return one.vertex == vertex; });
  };
  find_chain(contour, crossing, far, true);
  const auto own_edge = [&](int step) -> OwnEdge {
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
  return {.crossing = crossing,
          .ends = {end_of_edges(contour, crossing, 1), end_of_edges(contour, crossing, -1)},
          .own = {own_edge(1), own_edge(n - 1)}};
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
  crossing.edge = *std::ranges::min_element(chain_, {}, distance);
  return false;
}

void SelfCrossings::renew(const Contour& contour, std::vector<SelfCrossing>& crossings) {
  known_.clear();
  muted_.clear();
  if (crossings.empty()) return;
  const int n = contour.size;
  const std::vector<SelfCrossing> all = crossings;
  crossings.clear();
  for (const SelfCrossing& crossing : all) {
    const Known known = look_at(contour, crossing, all);
    if (!known.own[0].crosses && !known.own[1].crosses) continue;
    const auto vertex = static_cast<int>(crossing.vertex), number = static_cast<int>(known_.size());
    find_chain(contour, crossing, beside, false);
    for (const int edge : chain_) {
      muted_.push_back({{vertex, edge}, number});
      for (const int end : {edge, (edge + 1) % n})
        for (const int own : {vertex, (vertex + n - 1) % n}) muted_.push_back({{end, own}, number});
    }
    known_.push_back(known);
    crossings.push_back(crossing);
  }
  const auto pair = [](const Muted& one) { return std::pair(one.pair.vertex, one.pair.edge); };
  std::ranges::stable_sort(muted_, {}, pair);
  const auto repeated = std::ranges::unique(muted_, {}, pair);
  muted_.erase(repeated.begin(), repeated.end());
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

std::vector<SelfCrossings::Depth> SelfCrossings::depths(const Contour& contour) const {
  std::vector<Depth> depths;
  depths.reserve(known_.size());
  for (const Known& one : known_) depths.emplace_back(contour, one);
  return depths;
}

/// Calls visit() for every muted contact that is closer than the range.
template <class Visit>
void SelfCrossings::visit_contacts(const Contour& contour, const SelfContacts& contacts,
                                   const std::vector<Depth>& depths, Visit visit) const {
  for (const auto& [pair, crossing] : muted_) {
    if (are_neighbours(contacts, pair, contour.size)) continue;
    const Depth& depth = depths[crossing];
    Contact contact{.points = {pair.vertex, pair.edge, (pair.edge + 1) % contour.size}};
    std::array<Eigen::Array2d, 3> places;
    for (std::size_t k = 0; k < places.size(); ++k) {
      places[k] = place(contour, contact.points[k]);
      if (contact.points[k] == depth.vertex()) places[k] += depth.shift();
    }
    const Eigen::Array2d edge = places[2] - places[1], to_vertex = places[0] - places[1];
    const double length2 = edge.square().sum();
    contact.fraction = length2 > 0 ? std::clamp((to_vertex * edge).sum() / length2, 0.0, 1.0) : 0;
    const Eigen::Array2d away = to_vertex - contact.fraction * edge;
    const double distance = away.matrix().norm();
    contact.overlap = contacts.range() - distance;
    if (contact.overlap <= 0) continue;
    // A vertex on the edge is not pushed to either side.
    constexpr double round_off = 1e-9;
    contact.direction = distance > round_off * contacts.range() ? away / distance : Eigen::Array2d(0, 0);
    visit(contact, depth);
  }
}

double SelfCrossings::energy(const Contour& contour, const SelfContacts& contacts) const {
  const std::vector<Depth> depths = this->depths(contour);
  double energy = 0;
  for (std::size_t k = 0; k < depths.size(); ++k) {
    const double range = range_of(contacts, pair_of(known_[k].crossing), contour.size);
    energy += (range + depths[k].size() / 2) * depths[k].size();
  }
  visit_contacts(contour, contacts, depths,
                 [&](const Contact& one, const Depth&) { energy += one.overlap * one.overlap / 2; });
  return energy;
}

const std::vector<SelfCrossings::Push>& SelfCrossings::find_pushes(const Contour& contour,
                                                                   const SelfContacts& contacts) {
  pushes_.clear();
  const auto add = [&](int vertex, const Eigen::Array2d& force) { pushes_.push_back({vertex, force}); };
  const std::vector<Depth> depths = this->depths(contour);
  for (std::size_t k = 0; k < depths.size(); ++k)
    depths[k].add_derivative(
        -range_of(contacts, pair_of(known_[k].crossing), contour.size) - depths[k].size(), add);
  visit_contacts(contour, contacts, depths, [&](const Contact& one, const Depth& depth) {
    const std::array<double, 3> shares = {1, one.fraction - 1, -one.fraction};
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const Eigen::Array2d force = shares[k] * one.overlap * one.direction;
      add(one.points[k], force);
      if (one.points[k] == depth.vertex()) depth.add_derivative_of_shift(force, add);
    }
  });
  return pushes_;
}

}  // namespace clog

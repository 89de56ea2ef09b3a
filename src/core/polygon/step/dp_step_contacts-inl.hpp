/// Contacts of the contour, and obstacles near it; part of dp_step_kernel.cpp.

#if defined(CLOG_DP_STEP_CONTACTS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLOG_DP_STEP_CONTACTS
#undef CLOG_DP_STEP_CONTACTS
#else
#define CLOG_DP_STEP_CONTACTS
#endif

#include <hwy/contrib/math/math-inl.h>

#include <algorithm>
#include <cmath>

#include "core/polygon/step/dp_step_circles-inl.hpp"
#include "core/polygon/step/dp_step_holds-inl.hpp"
#include "core/polygon/step/dp_step_vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
// NOLINTBEGIN(misc-definitions-in-headers): part of one source, compiled for each instruction set
namespace clog::kernel::HWY_NAMESPACE {

/// Shifts every lane to the next lane, and sets the first lane to 0.
HWY_INLINE V to_next_lane(V v) {
  alignas(64) constexpr std::int64_t before[8] = {0, 0, 1, 2, 3, 4, 5, 6};
  return hn::IfThenZeroElse(hn::FirstN(D(), 1), hn::TableLookupLanes(v, hn::SetTableIndices(D(), before)));
}

/// `lanes` consecutive edges.
struct EdgeVectors {
  Pair begin, tangent;
  V length;
  HWY_INLINE EdgeVectors(int i, const StepArrays& a)
      : begin(load(a.position, i)), tangent(load(a.tangent, i)), length(load(a.length + i)) {}
};

/// For each edge of a vector, the point of the edge that is closest to a given point.
struct NearestPoints {
  V along;   ///< distance of the point from the first vertex of its edge
  V dx, dy;  ///< vector from the given point
  V distance2;

  HWY_INLINE NearestPoints(const EdgeVectors& edges, const Pair& point) {
    const auto& [begin, tangent, length] = edges;
    const V to_x = hn::Sub(point.x, begin.x), to_y = hn::Sub(point.y, begin.y);
    along = hn::Min(hn::Max(hn::MulAdd(to_x, tangent.x, hn::Mul(to_y, tangent.y)), all(0)), length);
    dx = hn::MulSub(along, tangent.x, to_x);
    dy = hn::MulSub(along, tangent.y, to_y);
    distance2 = hn::MulAdd(dx, dx, hn::Mul(dy, dy));
  }
  HWY_INLINE M are_nearer_than(V reach) const { return hn::Lt(distance2, hn::Mul(reach, reach)); }
};

/// Forces on edges, before they are distributed to the vertices.
class EdgePushes {
 public:
  HWY_INLINE EdgePushes() : x_(all(0)), y_(all(0)), along_x_(all(0)), along_y_(all(0)) {}
  /// Pushes edges off the points that they touch, with the force stiffness * (reach - distance). The place of
  /// the closest point on the edge determines how the edge's two vertices share the force.
  HWY_INLINE Pair add(const NearestPoints& nearest, M touch, V reach, V stiffness) {
    // For a point exactly on the edge, the direction is 0 and not NaN.
    const V inverse_distance = square_root(hn::Max(nearest.distance2, all(1e-300))).inverse;
    const V size = hn::IfThenElseZero(touch, hn::Mul(stiffness, hn::MulSub(reach, inverse_distance, all(1))));
    const Pair push{hn::Mul(size, nearest.dx), hn::Mul(size, nearest.dy)};
    x_ = hn::Add(x_, push.x);
    y_ = hn::Add(y_, push.y);
    along_x_ = hn::MulAdd(nearest.along, push.x, along_x_);
    along_y_ = hn::MulAdd(nearest.along, push.y, along_y_);
    return push;
  }
  /// Adds the forces to the vertices. @param i  the first edge
  HWY_INLINE void hand_out(int i, const EdgeVectors& edges, const StepArrays& a) const {
    const V inverse_length = reciprocal(edges.length);
    hand_out(x_, hn::Mul(along_x_, inverse_length), a.push.x + i);
    hand_out(y_, hn::Mul(along_y_, inverse_length), a.push.y + i);
  }

 private:
  V x_, y_, along_x_, along_y_;

  static HWY_INLINE void hand_out(V whole, V end, double* p) {
    // The sum is stored in one step. A load that overlaps two recent stores would have to wait.
    store(hn::Add(load(p), hn::Add(hn::Sub(whole, end), to_next_lane(end))), p);
    p[lanes] += hn::ExtractLane(end, lanes - 1);
  }
};

/// The numbers of the lanes, first in ascending, then in descending order. Each order occurs twice.
constexpr auto orders = [] {
  std::array<std::array<std::int64_t, std::size_t{2} * lanes>, 2> order{};
  for (int k = 0; k < 2 * lanes; ++k) {
    order[0][k] = k % lanes;
    order[1][k] = lanes - 1 - k % lanes;
  }
  return order;
}();

/// Consecutive vertices, one for each edge of a vector.
class PairedVertices {
 public:
  /// @param lane  the first of the item's edges to include
  HWY_INLINE PairedVertices(const SelfContacts::Item& item, int lane, const StepArrays& a)
      : first_(item.vertices + (item.backwards ? edges_per_group - lanes - lane : lane)),
        order_(orders[item.backwards].data()) {
    const auto order = hn::SetTableIndices(D(), order_);
    const Pair there = load_at(a.position, first_);
    place_ = {hn::TableLookupLanes(there.x, order), hn::TableLookupLanes(there.y, order)};
  }
  HWY_INLINE const Pair& place() const { return place_; }

  /// Adds the reaction to the force on the edges to the vertices. Reads and writes whole aligned vectors,
  /// because a load across two vectors that were just stored would have to wait for the cache.
  HWY_INLINE void push_back(const Pair& push, const StepArrays& a) const {
    const int beyond = first_ & (lanes - 1), aligned = first_ - beyond;
    const auto turned = hn::SetTableIndices(D(), order_ + lanes - beyond);
    const M later = lanes_of((1 << beyond) - 1, 0);
    const V x = hn::TableLookupLanes(push.x, turned), y = hn::TableLookupLanes(push.y, turned);
    subtract(hn::IfThenZeroElse(later, x), a.push.x + aligned);
    subtract(hn::IfThenZeroElse(later, y), a.push.y + aligned);
    subtract(hn::IfThenElseZero(later, x), a.push.x + aligned + lanes);
    subtract(hn::IfThenElseZero(later, y), a.push.y + aligned + lanes);
  }

 private:
  int first_;
  const std::int64_t* order_;
  Pair place_;

  static HWY_INLINE void subtract(V v, double* p) { store(hn::Sub(load(p), v), p); }
};

/// Repulsion of edges and vertices. Returns the smallest squared distance of a listed pair.
double push_off_each_other(const SelfContacts::Item* items, std::size_t num_items, const Contact& contact,
                           const StepArrays& a) {
  const V reach = all(contact.self_range), stiffness = all(contact.stiffness);
  V least = all(1e300);
  const SelfContacts::Item* const end = items + num_items;
  for (const SelfContacts::Item *begin = items, *next = items; begin != end; begin = next) {
    while (next != end && next->edges == begin->edges) ++next;
    for (int lane = 0; lane < edges_per_group; lane += lanes) {
      const int i = begin->edges + lane;
      const EdgeVectors edges(i, a);
      EdgePushes pushes;
      for (const SelfContacts::Item* item = begin; item != next; ++item) {
        const PairedVertices vertices(*item, lane, a);
        const NearestPoints nearest(edges, vertices.place());
        const M listed = lanes_of(item->pairs, lane), touch = hn::And(nearest.are_nearer_than(reach), listed);
        least = hn::Min(least, hn::IfThenElse(listed, nearest.distance2, least));
        if (hn::AllFalse(D(), touch)) continue;
        vertices.push_back(pushes.add(nearest, touch, reach, stiffness), a);
      }
      pushes.hand_out(i, edges, a);
    }
  }
  return hn::GetLane(hn::MinOfLanes(D(), least));
}

/// The smallest distance of the listed edges to their points.
HWY_INLINE double smallest(V distance2, M listed) {
  return std::sqrt(hn::GetLane(hn::MinOfLanes(D(), hn::IfThenElse(listed, distance2, all(1e300)))));
}

double pair_gaps(const SelfContacts::Item* items, std::size_t num_items, const Contact& contact,
                 const StepArrays& arrays, double* gaps) {
  const StepArrays a = arrays;
  double least = 0;
  for (std::size_t k = 0; k < num_items; ++k) {
    const SelfContacts::Item item = items[k];
    double distance = 1e150;
    for (int lane = 0; lane < edges_per_group; lane += lanes) {
      const PairedVertices vertices(item, lane, a);
      const NearestPoints nearest(EdgeVectors(item.edges + lane, a), vertices.place());
      distance = std::min(distance, smallest(nearest.distance2, lanes_of(item.pairs, lane)));
    }
    gaps[k] = distance - contact.self_range;
    least = std::min(least, gaps[k]);
  }
  return least;
}

double push(int n, const WallWindows& walls, const SelfContacts::Item* self, std::size_t num_self,
            const Contact& contact, const StepArrays& arrays) {
  const StepArrays a = arrays;
  if (num_self > 0) clear_pushes(n + edges_per_group - 1, a);
  push_off_circles(walls, contact, a);
  const double nearest2 = push_off_each_other(self, num_self, contact, a);
  fold_ends(a.push, n, num_self > 0 ? edges_per_group : 2);
  return std::sqrt(nearest2);
}

Held push_and_hold(int n, const HoldingCircles& walls, const WallGrip& grip, const SelfContacts::Item* self,
                   std::size_t num_self, const Contact& contact, const StepArrays& arrays) {
  const StepArrays a = arrays;
  const bool wets = grip.traction > 0;
  clear_pushes(n + edges_per_group - 1, a);
  const double taken = wets ? push_off_and_hold<true>(n, walls, grip, contact, a)
                            : push_off_and_hold<false>(n, walls, grip, contact, a);
  const double nearest2 = push_off_each_other(self, num_self, contact, a);
  if (num_self > 0) fold_ends(a.push, n, edges_per_group);
  return {.nearest_pair = std::sqrt(nearest2), .taken = taken};
}

/// Distances from a wedge for a vector of vertices. distance_to() of wedge.hpp computes this distance for one
/// vertex.
class WedgeVectors {
 public:
  explicit WedgeVectors(const WedgePlace& w)
      : x_(all(w.x)),
        y_(all(w.y)),
        axis_x_(all(w.axis_x)),
        axis_y_(all(w.axis_y)),
        cos_(all(w.cos)),
        sin_(all(w.sin)) {}

  struct Seen {
    V dx, dy;         ///< vector from the centre of the tip
    V across;         ///< distance from the axis, with its sign
    V to_flank;       ///< distance from the sharp wedge
    M is_before_tip;  ///< where the tip is nearer than the flank, so that `to_flank` is not the distance from
                      ///< the wedge

    HWY_INLINE V distance2() const { return hn::MulAdd(dx, dx, hn::Mul(dy, dy)); }
  };
  HWY_INLINE Seen seen_from(const Pair& place) const {
    const V dx = hn::Sub(place.x, x_), dy = hn::Sub(place.y, y_);
    const V along = hn::MulAdd(dx, axis_x_, hn::Mul(dy, axis_y_));
    const V across = hn::MulSub(dy, axis_x_, hn::Mul(dx, axis_y_));
    const V off = hn::Abs(across);
    return {dx, dy, across, hn::MulSub(off, cos_, hn::Mul(along, sin_)),
            hn::Lt(hn::MulAdd(off, sin_, hn::Mul(along, cos_)), all(0))};
  }
  /// Unit vector away from the nearest flank.
  HWY_INLINE void flank_normal(const Seen& seen, V& x, V& y) const {
    const V side_cos = hn::IfThenElse(hn::Lt(seen.across, all(0)), hn::Neg(cos_), cos_);
    x = hn::Neg(hn::MulAdd(side_cos, axis_y_, hn::Mul(sin_, axis_x_)));
    y = hn::MulSub(side_cos, axis_x_, hn::Mul(sin_, axis_y_));
  }

 private:
  V x_, y_, axis_x_, axis_y_, cos_, sin_;
};

void push_off_wedges(int n, const WedgePlace* wedges, std::size_t num_wedges, double range, double stiffness,
                     const StepArrays& arrays) {
  const StepArrays a = arrays;
  for (const WedgePlace* place = wedges; place != wedges + num_wedges; ++place) {
    const WedgeVectors wedge(*place);
    const V reach = all(range + place->radius);
    for_vectors(n, [&](int i, auto keep) CLOG_INLINE {
      const WedgeVectors::Seen seen = wedge.seen_from(load(a.position, i));
      const V r2 = seen.distance2();
      const M touches = hn::Or(hn::And(seen.is_before_tip, hn::Lt(r2, hn::Mul(reach, reach))),
                               hn::AndNot(seen.is_before_tip, hn::Lt(seen.to_flank, reach)));
      if (hn::AllFalse(D(), touches)) return;
      const auto [r, inverse_r] = square_root(hn::Max(r2, all(1e-300)));
      const V distance = hn::IfThenElse(seen.is_before_tip, r, seen.to_flank);
      const V push = keep(hn::IfThenElseZero(touches, hn::Mul(all(stiffness), hn::Sub(reach, distance))));
      V normal_x, normal_y;
      wedge.flank_normal(seen, normal_x, normal_y);
      normal_x = hn::IfThenElse(seen.is_before_tip, hn::Mul(seen.dx, inverse_r), normal_x);
      normal_y = hn::IfThenElse(seen.is_before_tip, hn::Mul(seen.dy, inverse_r), normal_y);
      const Pair before = load(a.push, i);
      store({hn::MulAdd(push, normal_x, before.x), hn::MulAdd(push, normal_y, before.y)}, a.push, i);
    });
  }
}

/// v^(-4/3), as the fourth power of y = v^(-1/3). The first guess of y uses the bits of v, which are nearly
/// the logarithm of v; the error of this guess is at most 0.103. Five terms of the series of (1 -
/// error)^(-1/3) reduce the error of y to 5e-6. Three terms of the series of (1 - error)^(-4/3) then correct
/// the fourth power.
inline V power_minus_four_thirds(V v) {
  const hn::RebindToSigned<D> bits;
  const V scaled = hn::MulAdd(hn::ConvertTo(D(), hn::BitCast(bits, v)), all(-1.0 / 3),
                              all((4.0 / 3 * 1023 - 0.068) * 4503599627370496.0));
  const V guess = hn::BitCast(D(), truncated(scaled));
  const V off = hn::NegMulAdd(v, hn::Mul(hn::Mul(guess, guess), guess), all(1));
  const V series = hn::MulAdd(off, hn::MulAdd(off, all(35.0 / 243), all(14.0 / 81)), all(2.0 / 9));
  const V y = hn::MulAdd(hn::Mul(guess, off), hn::MulAdd(off, series, all(1.0 / 3)), guess);
  const V y2 = hn::Mul(y, y), y4 = hn::Mul(y2, y2);
  const V error = hn::NegMulAdd(v, hn::Mul(y2, y), all(1));
  return hn::MulAdd(hn::Mul(y4, error), hn::MulAdd(error, all(14.0 / 9), all(4.0 / 3)), y4);
}

HWY_INLINE V distance(V squared) { return square_root(hn::Max(squared, all(1e-300))).root; }

/// Lowers distances[i] to the distance between vertex i and a wedge, but not below `shortest`.
void shrink_to_wedge_distances(int n, const NearWalls& walls, V shortest, const StepArrays& a,
                               const ContourArray& distances) {
  for (const WedgePlace* place = walls.wedges; place != walls.wedges + walls.num_wedges; ++place) {
    const WedgeVectors wedge(*place);
    const V radius = all(place->radius);
    for_vectors(n, [&](int i, auto) CLOG_INLINE {
      const WedgeVectors::Seen seen = wedge.seen_from(load(a.position, i));
      V to_wedge = seen.to_flank;
      if (!hn::AllFalse(D(), seen.is_before_tip))
        to_wedge = hn::IfThenElse(seen.is_before_tip, distance(seen.distance2()), to_wedge);
      store(hn::Max(hn::Min(load(distances + i), hn::Sub(to_wedge, radius)), shortest), distances + i);
    });
  }
}

template <bool four_thirds, bool alike>
void near_wall_rates_with(int n, const NearWalls& walls, const NearWallDrag& drag,
                          const KickCoefficients& coefficients, const StepArrays& arrays) {
  const StepArrays a = arrays;
  const V shortest = all(drag.shortest), power = all(-drag.exponent);
  const V far = all(drag.far_rate * drag.relative), near = all(drag.far_rate * drag.near_wall);
  const V h1 = all(coefficients.h1), h2 = all(coefficients.h2);
  const WallContacts::Item* end = walls.items;
  for (int group = 0; group * edges_per_group < n; ++group) {
    const WallContacts::Item* const begin = end;
    while (end != walls.items + walls.num_items && end->group == group) ++end;
    for (int i = group * edges_per_group; i < (group + 1) * edges_per_group; i += lanes) {
      const auto [x, y] = load(a.position, i);
      // All circles have equal radii, so the nearest circle is the one with the nearest centre, and one root
      // is enough.
      V nearest = all(1e300);
      for (const WallContacts::Item* circle = begin; circle != end; ++circle) {
        const V dx = hn::Sub(x, all(circle->x)), dy = hn::Sub(y, all(circle->y));
        const V r2 = hn::MulAdd(dx, dx, hn::Mul(dy, dy));
        nearest = hn::Min(nearest, alike ? r2 : hn::Sub(distance(r2), all(circle->reach - walls.range)));
      }
      if constexpr (alike) nearest = hn::Sub(distance(nearest), all(walls.radius));
      store(hn::Max(nearest, shortest), a.rate + i);
    }
  }
  shrink_to_wedge_distances(n, walls, shortest, a, a.rate);
  // This loop is separate from the search, because the processor can then overlap more of its long chains of
  // operations.
  for_vectors(n, [&](int i, auto) CLOG_INLINE {
    const V distance = load(a.rate + i);
    V rise;
    if constexpr (four_thirds)
      rise = power_minus_four_thirds(distance);
    else
      rise = hn::Exp(D(), hn::Mul(power, hn::Log(D(), distance)));
    const V rate = hn::MulAdd(near, rise, far);
    const V s = reciprocal(hn::MulAdd(h1, rate, all(1)));
    store(rate, a.rate + i);
    store(s, a.damping + i);
    store(hn::Mul(s, hn::NegMulAdd(h2, rate, all(1))), a.kept + i);
  });
}

void near_wall_rates(int n, const NearWalls& walls, const NearWallDrag& drag,
                     const KickCoefficients& coefficients, const StepArrays& arrays) {
  using Version =
      void (*)(int, const NearWalls&, const NearWallDrag&, const KickCoefficients&, const StepArrays&);
  constexpr Version versions[2][2] = {{near_wall_rates_with<false, false>, near_wall_rates_with<false, true>},
                                      {near_wall_rates_with<true, false>, near_wall_rates_with<true, true>}};
  versions[drag.exponent == 4.0 / 3][walls.alike](n, walls, drag, coefficients, arrays);
}

}  // namespace clog::kernel::HWY_NAMESPACE
// NOLINTEND(misc-definitions-in-headers)
HWY_AFTER_NAMESPACE();
#endif

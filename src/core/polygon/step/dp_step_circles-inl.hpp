/// Repulsion of the contour by circles; part of dp_step_kernel.cpp.

#if defined(CLOG_DP_STEP_CIRCLES) == defined(HWY_TARGET_TOGGLE)
#ifdef CLOG_DP_STEP_CIRCLES
#undef CLOG_DP_STEP_CIRCLES
#else
#define CLOG_DP_STEP_CIRCLES
#endif

#include <cstddef>
#include <cstdint>

#include "clog/core/droplet/shape.hpp"
#include "core/polygon/step/dp_step_vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
// NOLINTBEGIN(misc-definitions-in-headers): part of one source, compiled for each instruction set
namespace clog::kernel::HWY_NAMESPACE {

void clear_pushes(int n, const StepArrays& a) {
  const int end = (n / edges_per_group + 1) * edges_per_group;
  for (int i = 0; i < end; i += lanes) store({all(0), all(0)}, a.push, i);
}

HWY_INLINE M lanes_of(int bits, int first) {
  const std::uint8_t shifted[8] = {static_cast<std::uint8_t>(bits >> first)};
  return hn::LoadMaskBits(D(), shifted);
}

/// The lanes as bits.
HWY_INLINE unsigned bits_of(M mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(D(), mask, bytes);
  return bytes[0];
}

/// `lanes` consecutive edges of the refined contour (see refined()), two halves for each.
struct RefinedEdgeVectors {
  V x, y, middle_x, middle_y, next_x, next_y;
  HWY_INLINE RefinedEdgeVectors(int i, const StepArrays& a)
      : x(load_at(a.position.x + i)),
        y(load_at(a.position.y + i)),
        next_x(load_at(a.position.x + i + 1)),
        next_y(load_at(a.position.y + i + 1)) {
    middle_x = middle(x, next_x, load_at(a.position.x + i - 1), load_at(a.position.x + i + 2));
    middle_y = middle(y, next_y, load_at(a.position.y + i - 1), load_at(a.position.y + i + 2));
  }

 private:
  static HWY_INLINE V middle(V begin, V end, V before, V after) {
    return hn::MulAdd(all(refined_near), hn::Add(begin, end),
                      hn::Mul(all(refined_far), hn::Add(before, after)));
  }
};

/// The points of half edges that are closest to a circle's centre. Half in touch_kernel.cpp computes these
/// points more slowly, but with the same bits on all processors; dp_step.test.cpp compares the two.
struct NearestOnHalves {
  V fraction;  ///< fraction of the half edge from its beginning to the point
  V dx, dy;    ///< vector from the circle's centre
  V distance2;

  /// @param span  1: the whole half edge counts, 0: only its beginning counts
  HWY_INLINE NearestOnHalves(V begin_x, V begin_y, V end_x, V end_y, V centre_x, V centre_y, V span) {
    const V ex = hn::Sub(end_x, begin_x), ey = hn::Sub(end_y, begin_y);
    const V to_x = hn::Sub(centre_x, begin_x), to_y = hn::Sub(centre_y, begin_y);
    const V length2 = hn::Max(hn::MulAdd(ex, ex, hn::Mul(ey, ey)), all(1e-200));
    const V along = hn::Mul(hn::MulAdd(to_x, ex, hn::Mul(to_y, ey)), reciprocal(length2));
    fraction = hn::Min(hn::Max(along, all(0)), span);
    dx = hn::MulSub(fraction, ex, to_x);
    dy = hn::MulSub(fraction, ey, to_y);
    distance2 = hn::MulAdd(dx, dx, hn::Mul(dy, dy));
  }
  HWY_INLINE M are_nearer_than(V reach) const { return hn::Lt(distance2, hn::Mul(reach, reach)); }
  /// The force on half edges that touch the circle, stiffness * (reach - distance).
  HWY_INLINE Pair push(M touch, V reach, V stiffness) const {
    // For a point exactly at the centre, the direction is 0 and not NaN.
    const V inverse_distance = square_root(hn::Max(distance2, all(1e-300))).inverse;
    const V size = hn::IfThenElseZero(touch, hn::Mul(stiffness, hn::MulSub(reach, inverse_distance, all(1))));
    return {hn::Mul(size, dx), hn::Mul(size, dy)};
  }
};

/// Closest points of both halves of each edge to a circle's centre.
struct HalvesAtCircle {
  NearestOnHalves first, second;
  HWY_INLINE HalvesAtCircle(const RefinedEdgeVectors& e, V x, V y, V span)
      : first(e.x, e.y, e.middle_x, e.middle_y, x, y, span),
        second(e.middle_x, e.middle_y, e.next_x, e.next_y, x, y, span) {}
};

/// Forces of `lanes` edges of a window on their vertices. The force on an edge's middle acts on the four
/// vertices that determine it. `begin` is the force on the edge's first vertex, `end` the force on its
/// second, and `far` the force on each of the two neighbouring vertices.
struct WindowPushes {
  Pair begin, end, far;

  HWY_INLINE WindowPushes(const HalvesAtCircle& halves, const Pair& first, const Pair& second) {
    share(halves, first.x, second.x, begin.x, end.x, far.x);
    share(halves, first.y, second.y, begin.y, end.y, far.y);
  }

 private:
  static HWY_INLINE void share(const HalvesAtCircle& halves, V of_first, V of_second, V& begin, V& end,
                               V& far) {
    const V end_of_first = hn::Mul(halves.first.fraction, of_first);
    const V end_of_second = hn::Mul(halves.second.fraction, of_second);
    const V middle = hn::Add(end_of_first, hn::Sub(of_second, end_of_second));
    begin = hn::MulAdd(all(refined_near), middle, hn::Sub(of_first, end_of_first));
    end = hn::MulAdd(all(refined_near), middle, end_of_second);
    far = hn::Mul(all(refined_far), middle);
  }
};

/// Stores the forces in the arrays of the windows, or adds the forces to the arrays. @param p  entry of the
/// first edge in the first array
template <bool adds>
HWY_INLINE void keep_pushes(const WindowPushes& push, M listed, double* p, std::ptrdiff_t stride) {
  for (const V v : {push.begin.x, push.end.x, push.far.x, push.begin.y, push.end.y, push.far.y}) {
    hn::BlendedStore(adds ? hn::Add(load_at(p), v) : v, listed, D(), p);
    p += stride;
  }
}

/// Returns whether the circle touches one of the edges.
template <bool adds>
HWY_INLINE bool push_window(const WallWindow& window, V span, V stiffness, const WindowPushArrays& pushes,
                            const StepArrays& a) {
  const V reach = all(window.reach), reach_of_second = hn::Mul(span, reach);
  bool touches = false;
  for (int lane = 0; lane < edges_per_group; lane += lanes) {
    const int i = window.first + lane;
    const M listed = lanes_of(window.edges, lane);
    if (lanes < edges_per_group && hn::AllFalse(D(), listed)) continue;
    const HalvesAtCircle halves(RefinedEdgeVectors(i, a), all(window.x), all(window.y), span);
    const M first_touches = halves.first.are_nearer_than(reach);
    const M second_touches = halves.second.are_nearer_than(reach_of_second);
    const Pair first = halves.first.push(first_touches, reach, stiffness);
    const Pair second = halves.second.push(second_touches, reach, stiffness);
    keep_pushes<adds>(WindowPushes(halves, first, second), listed, pushes.first + i, pushes.stride);
    touches |= !hn::AllFalse(D(), hn::And(listed, hn::Or(first_touches, second_touches)));
  }
  return touches;
}

/// One coordinate of the forces that the windows exert on the vertices from p on.
/// @param p  forces of edges on their first vertices. The forces on the second vertices are one stride
/// further in memory, the forces on the two other vertices two strides
HWY_INLINE V push_on_vertices(const double* p, std::ptrdiff_t stride) {
  const double *end = p + stride, *far = end + stride;
  const V far_before = load(far - lanes), far_here = load(far);
  const V own = hn::Add(load(p), shifted_back<1>(end, load(end - lanes), load(end)));
  const V others =
      hn::Add(shifted_forward(far_here, load(far + lanes)), shifted_back<2>(far, far_before, far_here));
  return hn::Add(own, others);
}

/// Adds up the windows' forces on the vertices of a group.
HWY_INLINE void gather_pushes(int group, const WindowPushArrays& pushes, const ContourPair& push) {
  for (int lane = 0; lane < edges_per_group; lane += lanes) {
    const std::ptrdiff_t i = std::ptrdiff_t{group} * edges_per_group + lane;
    store(push_on_vertices(pushes.first + i, pushes.stride), push.x + i);
    store(push_on_vertices(pushes.first + 3 * pushes.stride + i, pushes.stride), push.y + i);
  }
}

/// Computes the forces on the vertices that windows may push, and overwrites the previous forces.
void push_off_circles(const WallWindows& given, const Contact& contact, const StepArrays& arrays) {
  // Local copies: the compiler would otherwise assume that every store may change these values.
  const WallWindows windows = given;
  const StepArrays a = arrays;
  const V span = all(contact.span), stiffness = all(contact.stiffness);
  for (int k = 0; k < windows.num_own; ++k)
    push_window<false>(windows.all[k], span, stiffness, windows.pushes, a);
  for (int k = windows.num_own; k < windows.num_all; ++k)
    push_window<true>(windows.all[k], span, stiffness, windows.pushes, a);
  for (int k = 0; k < windows.num_groups; ++k) gather_pushes(windows.groups[k], windows.pushes, a.push);
}

double circle_gaps(const WallContacts::Item* items, std::size_t num_items, const Contact& contact,
                   const StepArrays& arrays, double* gaps) {
  const StepArrays a = arrays;
  const V span = all(contact.span), far = all(1e150);
  V least = all(0);
  for (std::size_t k = 0; k < num_items; ++k) {
    const WallContacts::Item item = items[k];
    for (int lane = 0; lane < edges_per_group; lane += lanes) {
      const RefinedEdgeVectors edges(item.group * edges_per_group + lane, a);
      const HalvesAtCircle halves(edges, all(item.x), all(item.y), span);
      const V nearest = contact.span > 0 ? hn::Min(halves.first.distance2, halves.second.distance2)
                                         : halves.first.distance2;
      const V distance = square_root(hn::Max(nearest, all(1e-300))).root;
      const V gap = hn::Sub(hn::IfThenElse(lanes_of(item.edges, lane), distance, far), all(item.reach));
      hn::StoreU(gap, D(), gaps + k * edges_per_group + lane);
      least = hn::Min(least, gap);
    }
  }
  return hn::GetLane(hn::MinOfLanes(D(), least));
}

std::uint8_t edges_within(const double* gaps, double way) {
  unsigned bits = 0;
  for (int lane = 0; lane < edges_per_group; lane += lanes)
    bits |= bits_of(hn::Le(load_at(gaps + lane), all(way))) << lane;
  return static_cast<std::uint8_t>(bits);
}

}  // namespace clog::kernel::HWY_NAMESPACE
// NOLINTEND(misc-definitions-in-headers)
HWY_AFTER_NAMESPACE();
#endif

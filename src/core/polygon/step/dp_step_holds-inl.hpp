/// Circles that push the contour off and hold it by friction; part of dp_step_kernel.cpp.

#if defined(CLOG_DP_STEP_HOLDS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLOG_DP_STEP_HOLDS
#undef CLOG_DP_STEP_HOLDS
#else
#define CLOG_DP_STEP_HOLDS
#endif

#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/polygon/step/dp_step_circles-inl.hpp"

HWY_BEFORE_NAMESPACE();
// NOLINTBEGIN(misc-definitions-in-headers): part of one source, compiled for each instruction set
namespace clog::kernel::HWY_NAMESPACE {

/// Adds to each vertex the length of the interface on a circle that belongs to the vertex. Three quarters of
/// the length of each half edge in contact belong to the vertex at its end, one quarter to the other vertex
/// of the edge.
void add_wetted(const WallWindow& window, V span, const StepArrays& a, const ContourArray& wetted) {
  const V reach = all(window.reach), zero = all(0);
  for (int lane = 0; lane < edges_per_group; lane += lanes) {
    const int i = window.first + lane;
    const M listed = lanes_of(window.edges, lane);
    const RefinedEdgeVectors e(i, a);
    const HalvesAtCircle halves(e, all(window.x), all(window.y), span);
    const auto length = [&](const NearestOnHalves& half, V dx, V dy) {
      const M touches = hn::And(listed, half.are_nearer_than(reach));
      const V squared = hn::Max(hn::MulAdd(dx, dx, hn::Mul(dy, dy)), all(1e-300));
      return hn::IfThenElse(touches, square_root(squared).root, zero);
    };
    const V first = length(halves.first, hn::Sub(e.middle_x, e.x), hn::Sub(e.middle_y, e.y));
    const V second = length(halves.second, hn::Sub(e.next_x, e.middle_x), hn::Sub(e.next_y, e.middle_y));
    const V own = hn::MulAdd(all(0.75), first, hn::Mul(all(0.25), second));
    const V of_next = hn::MulAdd(all(0.25), first, hn::Mul(all(0.75), second));
    hn::StoreU(hn::Add(load_at(wetted + i), own), D(), wetted + i);
    hn::StoreU(hn::Add(load_at(wetted + i + 1), of_next), D(), wetted + i + 1);
  }
}

/// Edges push up to one vertex before the contour and `beyond` vertices after it. Adds these forces to the
/// vertices at the contour's other end.
HWY_INLINE void fold_ends(const ContourArray& p, int n, int beyond = 2) {
  p[n - 1] += std::exchange(p[-1], 0);
  for (int i = 0; i < beyond; ++i) p[i] += std::exchange(p[n + i], 0);
}
HWY_INLINE void fold_ends(const ContourPair& p, int n, int beyond = 2) {
  fold_ends(p.x, n, beyond);
  fold_ends(p.y, n, beyond);
}

/// Places of the vertices of a vector relative to a circle.
struct CircleAtVertices {
  V normal_x, normal_y;
  V inverse;  ///< inverse of the distance from the centre

  HWY_INLINE CircleAtVertices(const HoldingCircle& circle, std::ptrdiff_t i, const StepArrays& a) {
    const Pair place = load(a.position, i);
    const V dx = hn::Sub(place.x, all(circle.x)), dy = hn::Sub(place.y, all(circle.y));
    inverse = square_root(hn::Max(hn::MulAdd(dx, dx, hn::Mul(dy, dy)), all(1e-300))).inverse;
    normal_x = hn::Mul(dx, inverse);
    normal_y = hn::Mul(dy, inverse);
  }
};

/// Adds one circle's normal forces and friction to the forces on a group. Returns the work done on the wall.
/// WallFriction::follow() is the version for one vertex; dp_step.test.cpp compares the two functions.
template <bool wets>
HWY_INLINE V hold_group(const HoldingCircle& circle, int entry, const HoldingCircles& walls,
                        const WallGrip& grip, const StepArrays& a) {
  const V coefficient = all(circle.layer == 0 ? grip.coefficient : grip.coefficient_of_layers);
  const V traction = all(circle.layer == 0 ? grip.traction : 0);
  const V radius = all(circle.radius), stiffness = all(grip.stiffness);
  V taken = all(0);
  const unsigned held_before = walls.holds[entry];
  unsigned holds = 0;
  for (int lane = 0; lane < edges_per_group; lane += lanes) {
    const std::ptrdiff_t i = std::ptrdiff_t{walls.groups[entry]} * edges_per_group + lane;
    const std::ptrdiff_t k = std::ptrdiff_t{entry} * edges_per_group + lane;
    const V push_x = load(walls.push.x + i), push_y = load(walls.push.y + i);
    const M is_known = lanes_of(static_cast<int>(held_before), lane);
    M touched_or_held = hn::Or(is_known, hn::Or(hn::Ne(push_x, all(0)), hn::Ne(push_y, all(0))));
    // The closest point of a half edge may be its end, so the wall does not push every vertex that it wets.
    if constexpr (wets) touched_or_held = hn::Or(touched_or_held, hn::Gt(load(walls.wetted + i), all(0)));
    if (hn::AllFalse(D(), touched_or_held)) continue;
    const CircleAtVertices at(circle, i, a);
    // At the end of a contact, the middle of the last edge pulls the next vertex a little towards the wall
    // (refined_far is negative). This pull does not count as a normal force.
    const V push = hn::Max(hn::MulAdd(push_x, at.normal_x, hn::Mul(push_y, at.normal_y)), all(0));
    V bears = hn::Mul(coefficient, push);
    if constexpr (wets) bears = hn::MulAdd(traction, load(walls.wetted + i), bears);
    const M touches = hn::Gt(bears, all(0));

    // The wall's point closest to the vertex is radius * normal. The slip is positive along (-normal_y,
    // normal_x).
    const V anchor_x = load(walls.anchor_x + k), anchor_y = load(walls.anchor_y + k);
    const V slip =
        hn::IfThenElseZero(is_known, hn::MulSub(at.normal_y, anchor_x, hn::Mul(at.normal_x, anchor_y)));
    const V spring = hn::Mul(stiffness, hn::Mul(radius, at.inverse));
    const V most = hn::Mul(bears, reciprocal(spring));
    const V held = hn::Min(hn::Max(slip, hn::Neg(most)), most);
    const M rests = hn::And(is_known, hn::Eq(held, slip));
    store(hn::IfThenElse(rests, anchor_x, hn::MulAdd(radius, at.normal_x, hn::Mul(held, at.normal_y))),
          walls.anchor_x + k);
    store(hn::IfThenElse(rests, anchor_y, hn::MulSub(radius, at.normal_y, hn::Mul(held, at.normal_x))),
          walls.anchor_y + k);
    // Work on the wall by the integrator's trapezoidal rule: the old force acts on half of the path, the new
    // force on the other half. If the vertex has left the wall, the spring's energy is lost.
    const V before = load(walls.slip + k);
    const V lost =
        hn::IfThenElse(touches, hn::Mul(hn::Add(before, held), hn::Sub(slip, held)), hn::Mul(before, before));
    taken = hn::MulAdd(all(0.5), hn::IfThenElseZero(is_known, lost), taken);
    store(hn::IfThenElseZero(touches, held), walls.slip + k);
    holds |= bits_of(touches) << lane;

    const V pull = hn::Mul(spring, held);
    const V added_x = hn::MulAdd(pull, at.normal_y, push_x),
            added_y = hn::NegMulAdd(pull, at.normal_x, push_y);
    const Pair others = load(a.push, i);
    store({hn::Add(others.x, added_x), hn::Add(others.y, added_y)}, a.push, i);
  }
  walls.holds[entry] = static_cast<std::uint8_t>(holds);
  return taken;
}

/// Adds up one circle's forces on the vertices and the lengths in contact with it.
template <bool wets>
HWY_INLINE void gather_circle(int n, const HoldingCircle& circle, const HoldingCircles& walls, V span,
                              const StepArrays& a) {
  for (int k = circle.first_group; k < circle.end_group; ++k)
    gather_pushes(walls.groups[k], circle.pushes, walls.push);
  if constexpr (wets) {
    for (int k = circle.first_group; k < circle.end_group; ++k)
      for (int lane = 0; lane < edges_per_group; lane += lanes)
        store(all(0), walls.wetted + std::ptrdiff_t{walls.groups[k]} * edges_per_group + lane);
    for (int k = circle.first_window; k < circle.end_window; ++k)
      add_wetted(walls.windows[k], span, a, walls.wetted);
  }
  if (circle.wraps) {
    fold_ends(walls.push, n);
    if constexpr (wets) fold_ends(walls.wetted, n);
  }
}

template <bool wets>
double push_off_and_hold(int n, const HoldingCircles& given, const WallGrip& grip, const Contact& contact,
                         const StepArrays& a) {
  const HoldingCircles walls = given;
  const V span = all(contact.span), stiffness = all(contact.stiffness);
  const int num_groups = (n + edges_per_group - 1) / edges_per_group;
  V taken = all(0);
  for (const HoldingCircle* circle = walls.all; circle != walls.all + walls.num; ++circle) {
    for (int k = circle->first_window; k < circle->end_window; ++k)
      push_window<false>(walls.windows[k], span, stiffness, circle->pushes, a);
    gather_circle<wets>(n, *circle, walls, span, a);
    for (int k = circle->first_group; k < circle->end_group; ++k)
      if (walls.groups[k] >= 0 && walls.groups[k] < num_groups)
        taken = hn::Add(taken, hold_group<wets>(*circle, k, walls, grip, a));
  }
  return sum(taken);
}

}  // namespace clog::kernel::HWY_NAMESPACE
// NOLINTEND(misc-definitions-in-headers)
HWY_AFTER_NAMESPACE();
#endif

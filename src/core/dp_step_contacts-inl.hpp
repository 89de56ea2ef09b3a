/// What touches the contour and what is near it; part of dp_step_kernel.cpp.

#if defined(CLOG_DP_STEP_CONTACTS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLOG_DP_STEP_CONTACTS
#undef CLOG_DP_STEP_CONTACTS
#else
#define CLOG_DP_STEP_CONTACTS
#endif

#include <hwy/contrib/math/math-inl.h>

#include <utility>

#include "core/dp_step_vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clog::kernel::HWY_NAMESPACE {

void clear_group(int group, const StepArrays& a) {
  for (int lane = 0; lane < edges_per_group; lane += lanes) {
    store(all(0), a.push_x + group * edges_per_group + lane);
    store(all(0), a.push_y + group * edges_per_group + lane);
  }
}

void clear_pushes(int n, const StepArrays& a) {
  for (int group = 0; group * edges_per_group <= n; ++group) clear_group(group, a);
}

/// Every lane to the next one; 0 to the first.
inline V to_next_lane(V v) {
  alignas(64) constexpr std::int64_t before[8] = {0, 0, 1, 2, 3, 4, 5, 6};
  return hn::IfThenZeroElse(hn::FirstN(D(), 1), hn::TableLookupLanes(v, hn::SetTableIndices(D(), before)));
}

/// Pushes the listed edges of a group off a point by stiffness (reach - distance), where that is positive.
/// Returns the sum of the pushes.
struct Push {
  double x = 0, y = 0;
};
inline Push push_off_point(int group, std::uint8_t edges, V px, V py, V reach, V stiffness, V span,
                           const StepArrays& a) {
  Push total;
  for (int lane = 0; lane < edges_per_group; lane += lanes) {
    const int i = group * edges_per_group + lane;
    const V tx = load(a.tangent_x + i), ty = load(a.tangent_y + i), length = load(a.length + i);
    const V to_x = hn::Sub(px, load(a.x + i)), to_y = hn::Sub(py, load(a.y + i));
    const V along = hn::Min(hn::Max(hn::MulAdd(to_x, tx, hn::Mul(to_y, ty)), all(0)), hn::Mul(length, span));
    const V dx = hn::MulSub(along, tx, to_x), dy = hn::MulSub(along, ty, to_y);
    const V distance2 = hn::MulAdd(dx, dx, hn::Mul(dy, dy));
    const std::uint8_t bits[8] = {static_cast<std::uint8_t>(edges >> lane)};
    const M touches = hn::And(hn::Lt(distance2, hn::Mul(reach, reach)), hn::LoadMaskBits(D(), bits));
    if (hn::AllFalse(D(), touches)) continue;
    // A point on the very centre gets no direction, but no NaN.
    const V inverse_distance = square_root(hn::Max(distance2, all(1e-300))).inverse;
    const V push =
        hn::IfThenElseZero(touches, hn::Mul(stiffness, hn::MulSub(reach, inverse_distance, all(1))));
    const V fx = hn::Mul(push, dx), fy = hn::Mul(push, dy);
    // The edge's two vertices share it as the nearest point divides the edge.
    const V fraction = hn::Div(along, length);
    const V end_x = hn::Mul(fraction, fx), end_y = hn::Mul(fraction, fy);
    // Added in one go: what was just stored elsewhere could not be loaded at once.
    const V own_x = hn::Add(hn::Sub(fx, end_x), to_next_lane(end_x));
    const V own_y = hn::Add(hn::Sub(fy, end_y), to_next_lane(end_y));
    store(hn::Add(load(a.push_x + i), own_x), a.push_x + i);
    store(hn::Add(load(a.push_y + i), own_y), a.push_y + i);
    a.push_x[i + lanes] += hn::ExtractLane(end_x, lanes - 1);
    a.push_y[i + lanes] += hn::ExtractLane(end_y, lanes - 1);
    total.x += sum(fx);
    total.y += sum(fy);
  }
  return total;
}

void push(int n, const WallContacts::Item* walls, std::size_t num_walls, const SelfContacts::Item* self,
          std::size_t num_self, const Contact& contact, const StepArrays& arrays) {
  const StepArrays a = arrays;
  // An edge's end may be the first vertex of the next group, or of the contour.
  for (const WallContacts::Item* item = walls; item != walls + num_walls; ++item) {
    clear_group(item->group, a);
    clear_group(item->group + 1, a);
  }
  for (const SelfContacts::Item* item = self; item != self + num_self; ++item) {
    clear_group(item->group, a);
    clear_group(item->group + 1, a);
    clear_group(item->vertex / edges_per_group, a);
  }
  clear_group(0, a);
  a.push_x[n] = a.push_y[n] = 0;

  const V stiffness = all(contact.stiffness), span = all(contact.span);
  for (const WallContacts::Item* item = walls; item != walls + num_walls; ++item)
    push_off_point(item->group, item->edges, all(item->x), all(item->y), all(item->reach), stiffness, span,
                   a);
  const V diameter = all(contact.diameter), whole = all(1);
  for (const SelfContacts::Item* item = self; item != self + num_self; ++item) {
    const Push pushed = push_off_point(item->group, item->edges, all(a.x[item->vertex]),
                                       all(a.y[item->vertex]), diameter, stiffness, whole, a);
    a.push_x[item->vertex] -= pushed.x;
    a.push_y[item->vertex] -= pushed.y;
  }
  a.push_x[0] += std::exchange(a.push_x[n], 0);
  a.push_y[0] += std::exchange(a.push_y[n], 0);
}

/// v^(-4/3) by way of y = v^(-1/3): a first guess from the bits of a number, which are nearly its logarithm,
/// then twice the first terms of (1 - error)^(-1/3). The guess leaves an error of at most 0.103, five terms
/// leave 5e-6, three more nothing.
inline V power_minus_four_thirds(V v) {
  const hn::RebindToSigned<D> bits;
  const V scaled = hn::MulAdd(hn::ConvertTo(D(), hn::BitCast(bits, v)), all(-1.0 / 3),
                              all((4.0 / 3 * 1023 - 0.068) * 4503599627370496.0));
  V y = hn::BitCast(D(), hn::ConvertTo(bits, scaled));
  V error = hn::NegMulAdd(v, hn::Mul(hn::Mul(y, y), y), all(1));
  const V series = hn::MulAdd(error, hn::MulAdd(error, all(35.0 / 243), all(14.0 / 81)), all(2.0 / 9));
  y = hn::MulAdd(hn::Mul(y, error), hn::MulAdd(error, series, all(1.0 / 3)), y);
  error = hn::NegMulAdd(v, hn::Mul(hn::Mul(y, y), y), all(1));
  y = hn::MulAdd(hn::Mul(y, error), hn::MulAdd(error, all(2.0 / 9), all(1.0 / 3)), y);
  return hn::Mul(hn::Mul(y, y), hn::Mul(y, y));
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
      const V x = load(a.x + i), y = load(a.y + i);
      V nearest = load_at(walls.other_distance + i);
      V nearest2 = all(1e300);
      for (const WallContacts::Item* circle = begin; circle != end; ++circle) {
        const V dx = hn::Sub(x, all(circle->x)), dy = hn::Sub(y, all(circle->y));
        const V r2 = hn::MulAdd(dx, dx, hn::Mul(dy, dy));
        if constexpr (alike)
          nearest2 = hn::Min(nearest2, r2);
        else
          nearest = hn::Min(
              nearest, hn::Sub(square_root(hn::Max(r2, all(1e-300))).root, all(circle->reach - walls.range)));
      }
      if constexpr (alike)
        nearest =
            hn::Min(nearest, hn::Sub(square_root(hn::Max(nearest2, all(1e-300))).root, all(walls.radius)));
      store(hn::Max(nearest, shortest), a.rate + i);
    }
  }
  // Apart from the search, or the processor sees too few of these long chains at once.
  for_vectors(n, [&](int i, auto) CLOG_INLINE {
    const V distance = load(a.rate + i);
    V rise;
    if constexpr (four_thirds)
      rise = power_minus_four_thirds(distance);
    else
      rise = hn::Exp(D(), hn::Mul(power, hn::Log(D(), distance)));
    const V rate = hn::MulAdd(near, rise, far);
    const V s = hn::Div(all(1), hn::MulAdd(h1, rate, all(1)));
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
HWY_AFTER_NAMESPACE();
#endif

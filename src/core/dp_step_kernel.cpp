#include "dp_step_kernel.hpp"

#include <utility>

#include "clog/core/error.hpp"
#include "clog/core/instruction_set.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/dp_step_kernel.cpp"
// Three are enough: any processor, AVX2, AVX-512. (The others bring nothing to double precision.)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#include <hwy/foreach_target.h>
// The targets' code follows.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace clog::kernel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, edges_per_group>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

constexpr int lanes = static_cast<int>(MaxLanes(D()));

inline V load(const double* p) { return hn::Load(D(), p); }
inline V load_at(const double* p) { return hn::LoadU(D(), p); }
inline void store(V v, double* p) { hn::Store(v, D(), p); }
inline V all(double value) { return hn::Set(D(), value); }
inline double sum(V v) { return hn::GetLane(hn::SumOfLanes(D(), v)); }

/// sqrt(v) and 1/sqrt(v) to the last bit or two.
struct Root {
  V root, inverse;
};
inline Root square_root(V v) {
#if HWY_TARGET == HWY_AVX3
  // A guess of 14 bits and the first terms of (1 - error)^(-1/2).
  const V inverse{_mm512_rsqrt14_pd(v.raw)};
  const V root = hn::Mul(v, inverse);
  const V error = hn::NegMulAdd(root, inverse, all(1));
  const V missing =
      hn::Mul(error, hn::MulAdd(error, hn::MulAdd(error, all(5.0 / 16), all(3.0 / 8)), all(1.0 / 2)));
  return {hn::MulAdd(root, missing, root), hn::MulAdd(inverse, missing, inverse)};
#else
  const V root = hn::Sqrt(v);
  return {root, hn::Div(all(1), root)};
#endif
}

/// A body that is not inlined keeps its sums in memory.
#undef CLOG_INLINE
#if defined(__GNUC__)
#define CLOG_INLINE __attribute__((always_inline))
#else
#define CLOG_INLINE
#endif

/// Calls body(i, keep) for every vector of the contour. keep(v) zeroes lanes beyond the last vertex.
template <class Body>
HWY_INLINE void for_vectors(int n, Body body) {
  int i = 0;
  for (; i + lanes <= n; i += lanes) body(i, [](V v) { return v; });
  if (i < n) {
    const M inside = hn::FirstN(D(), static_cast<std::size_t>(n - i));
    body(i, [inside](V v) { return hn::IfThenElseZero(inside, v); });
  }
}

/// Repeats the contour beyond its ends.
inline void close(double* p, int n) {
  p[-1] = p[n - 1];
  for (int k = 0; k < edges_per_group; ++k) p[n + k] = p[k];
}

template <bool with_moments>
Sums measure_with(int n, const StepArrays& arrays) {
  const StepArrays a = arrays;  // a copy that stores cannot change
  V perimeter = all(0), twice_area = all(0), moment_x = all(0), moment_y = all(0);
  for_vectors(n, [&](int i, auto keep) CLOG_INLINE {
    const V x = load(a.x + i), y = load(a.y + i);
    const V next_x = load_at(a.x + i + 1), next_y = load_at(a.y + i + 1);
    const V ex = hn::Sub(next_x, x), ey = hn::Sub(next_y, y);
    const V length2 = hn::MulAdd(ex, ex, hn::Mul(ey, ey));
    const auto [length, inverse_length] = square_root(length2);
    const V cross = keep(hn::MulSub(x, ey, hn::Mul(y, ex)));
    store(hn::Mul(ex, inverse_length), a.tangent_x + i);
    store(hn::Mul(ey, inverse_length), a.tangent_y + i);
    store(length, a.length + i);
    perimeter = hn::Add(perimeter, keep(length));
    twice_area = hn::Add(twice_area, cross);
    if constexpr (with_moments) {
      moment_x = hn::MulAdd(cross, hn::Add(x, next_x), moment_x);
      moment_y = hn::MulAdd(cross, hn::Add(y, next_y), moment_y);
    }
  });
  for (double* p : {a.tangent_x, a.tangent_y, a.length}) close(p, n);
  return {sum(twice_area) / 2, sum(perimeter), sum(moment_x) / 6, sum(moment_y) / 6};
}

Sums measure(int n, bool with_moments, const StepArrays& arrays) {
  return with_moments ? measure_with<true>(n, arrays) : measure_with<false>(n, arrays);
}

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

template <bool elastic, bool on_area, bool varying_rate>
KickSums kick_with(int n, const KickTerms& terms, const InterfaceCoefficients& interface,
                   const KickCoefficients& coefficients, const StepArrays& arrays) {
  const StepArrays a = arrays;
  const V line_tension = all(interface.line_tension);
  const V spring = all(interface.spring), spreading = all(interface.spreading);
  const V half_pressure = all(interface.half_pressure);
  const V body_force = all(interface.body_force), vertex_weight = all(interface.vertex_weight);
  const V centre_x = all(-3 * interface.centre_x), centre_y = all(-3 * interface.centre_y);
  const V h1 = all(coefficients.h1), m1 = all(coefficients.m1);
  const V h2 = all(coefficients.h2), m2 = all(coefficients.m2);
  const double one_s = varying_rate ? 1 : 1 / (1 + coefficients.h1 * terms.rate);
  const V same_s = all(one_s), same_keep = all(one_s * (1 - coefficients.h2 * terms.rate));
  V spread_x = all(0), spread_y = all(0);
  V w_x = all(0), w_y = all(0), gw_x = all(0), gw_y = all(0), gg_xx = all(0), gg_xy = all(0), gg_yy = all(0);
  V s_sum = all(0), g_xx = all(0), g_xy = all(0), g_yx = all(0), g_yy = all(0);
  for_vectors(n, [&](int i, auto keep) CLOG_INLINE {
    // What takes long comes first: the processor does not look far ahead.
    const V length = load(a.length + i), length_before = load_at(a.length + i - 1);
    V unevenness, s;
    if constexpr (!elastic)
      unevenness = hn::Div(hn::Sub(length, length_before), hn::Add(length, length_before));
    if constexpr (varying_rate) s = hn::Div(all(1), hn::MulAdd(h1, load(a.rate + i), all(1)));

    const V before_x = load_at(a.x + i - 1), before_y = load_at(a.y + i - 1);
    const V after_x = load_at(a.x + i + 1), after_y = load_at(a.y + i + 1);
    // The chord between the neighbours, turned outwards.
    const V out_x = hn::Sub(after_y, before_y), out_y = hn::Sub(before_x, after_x);
    V fx = hn::MulAdd(half_pressure, out_x, load(a.push_x + i));
    V fy = hn::MulAdd(half_pressure, out_y, load(a.push_y + i));
    V gxx, gxy, gyx, gyy;
    if constexpr (on_area) {
      // A vertex moves the area's centroid by the triangle between it and its neighbours: m n^T + k I, with m
      // the sum of the three corners relative to the centroid, n the chord turned outwards, k twice the area.
      const V x = load(a.x + i), y = load(a.y + i);
      const V corners_x = hn::Add(hn::Add(before_x, after_x), hn::Add(x, centre_x));
      const V corners_y = hn::Add(hn::Add(before_y, after_y), hn::Add(y, centre_y));
      const V twice_area = hn::MulAdd(hn::Sub(x, before_x), out_x, hn::Mul(hn::Sub(y, before_y), out_y));
      gxx = keep(hn::MulAdd(corners_x, out_x, twice_area));
      gxy = keep(hn::Mul(corners_x, out_y));
      gyx = keep(hn::Mul(corners_y, out_x));
      gyy = keep(hn::MulAdd(corners_y, out_y, twice_area));
      store(gxx, a.grad_xx + i);
      store(gxy, a.grad_xy + i);
      store(gyx, a.grad_yx + i);
      store(gyy, a.grad_yy + i);
      fx = hn::MulAdd(body_force, gxx, fx);
      fy = hn::MulAdd(body_force, gxy, fy);
    } else {
      fx = hn::Add(fx, vertex_weight);
    }

    const V tx = load(a.tangent_x + i), ty = load(a.tangent_y + i);
    const V tangent_before_x = load_at(a.tangent_x + i - 1), tangent_before_y = load_at(a.tangent_y + i - 1);
    if constexpr (elastic) {
      const V pull = hn::MulAdd(spring, length, line_tension);
      const V pull_before = hn::MulAdd(spring, length_before, line_tension);
      fx = hn::MulAdd(pull, tx, hn::NegMulAdd(pull_before, tangent_before_x, fx));
      fy = hn::MulAdd(pull, ty, hn::NegMulAdd(pull_before, tangent_before_y, fy));
    } else {
      fx = hn::MulAdd(line_tension, hn::Sub(tx, tangent_before_x), fx);
      fy = hn::MulAdd(line_tension, hn::Sub(ty, tangent_before_y), fy);
      const V cosine = hn::Max(hn::MulAdd(tx, tangent_before_x, hn::Mul(ty, tangent_before_y)), all(0));
      const V spread = hn::Mul(hn::Mul(spreading, hn::Mul(cosine, cosine)), unevenness);
      fx = hn::NegMulAdd(spread, out_y, fx);
      fy = hn::MulAdd(spread, out_x, fy);
      spread_x = hn::NegMulAdd(keep(spread), out_y, spread_x);
      spread_y = hn::MulAdd(keep(spread), out_x, spread_y);
    }

    // Where s is the same for all it is left to the end.
    V wx = hn::MulAdd(m1, fx, load(a.vx + i)), wy = hn::MulAdd(m1, fy, load(a.vy + i));
    V kept = same_keep;
    if constexpr (varying_rate) {
      store(s, a.damping + i);
      kept = hn::NegMulAdd(h2, load(a.rate + i), all(1));
      wx = hn::Mul(wx, s);
      wy = hn::Mul(wy, s);
    }
    store(hn::MulAdd(wx, kept, hn::Mul(m2, fx)), a.vx + i);
    store(hn::MulAdd(wy, kept, hn::Mul(m2, fy)), a.vy + i);
    if (terms.keeps_kicked) {
      store(hn::Mul(wx, same_s), a.kicked_x + i);
      store(hn::Mul(wy, same_s), a.kicked_y + i);
    }
    w_x = hn::Add(w_x, keep(wx));
    w_y = hn::Add(w_y, keep(wy));
    if constexpr (varying_rate) s_sum = hn::Add(s_sum, keep(s));
    if constexpr (on_area) {
      gw_x = hn::MulAdd(gxx, wx, hn::MulAdd(gxy, wy, gw_x));
      gw_y = hn::MulAdd(gyx, wx, hn::MulAdd(gyy, wy, gw_y));
      V sxx = gxx, sxy = gxy, syx = gyx, syy = gyy;
      if constexpr (varying_rate) {
        sxx = hn::Mul(s, gxx);
        sxy = hn::Mul(s, gxy);
        syx = hn::Mul(s, gyx);
        syy = hn::Mul(s, gyy);
        g_xx = hn::Add(g_xx, sxx);
        g_xy = hn::Add(g_xy, sxy);
        g_yx = hn::Add(g_yx, syx);
        g_yy = hn::Add(g_yy, syy);
      }
      gg_xx = hn::MulAdd(sxx, gxx, hn::MulAdd(sxy, gxy, gg_xx));
      gg_xy = hn::MulAdd(sxx, gyx, hn::MulAdd(sxy, gyy, gg_xy));
      gg_yy = hn::MulAdd(syx, gyx, hn::MulAdd(syy, gyy, gg_yy));
    }
  });
  KickSums sums{.spread_x = sum(spread_x),
                .spread_y = sum(spread_y),
                .w_x = sum(w_x),
                .w_y = sum(w_y),
                .gw_x = sum(gw_x),
                .gw_y = sum(gw_y),
                .gg_xx = sum(gg_xx),
                .gg_xy = sum(gg_xy),
                .gg_yy = sum(gg_yy),
                .s = sum(s_sum),
                .g_xx = sum(g_xx),
                .g_xy = sum(g_xy),
                .g_yx = sum(g_yx),
                .g_yy = sum(g_yy)};
  if constexpr (!varying_rate) {
    sums.s = n * one_s;
    sums.w_x *= one_s;
    sums.w_y *= one_s;
    sums.gw_x *= one_s;
    sums.gw_y *= one_s;
    sums.gg_xx *= one_s;
    sums.gg_xy *= one_s;
    sums.gg_yy *= one_s;
  }
  return sums;
}

KickSums kick(int n, const KickTerms& terms, const InterfaceCoefficients& interface,
              const KickCoefficients& coefficients, const StepArrays& arrays) {
  using Version = KickSums (*)(int, const KickTerms&, const InterfaceCoefficients&, const KickCoefficients&,
                               const StepArrays&);
  constexpr Version versions[2][2][2] = {{{kick_with<false, false, false>, kick_with<false, false, true>},
                                          {kick_with<false, true, false>, kick_with<false, true, true>}},
                                         {{kick_with<true, false, false>, kick_with<true, false, true>},
                                          {kick_with<true, true, false>, kick_with<true, true, true>}}};
  return versions[terms.elastic][terms.on_area][terms.varying_rate](n, terms, interface, coefficients,
                                                                    arrays);
}

template <bool coupled, bool on_area, bool varying_rate>
void drift_with(int n, const KickTerms& terms, const KickCoefficients& coefficients, const double (&c)[2],
                const double (&area)[2], double time_step, const StepArrays& arrays) {
  const StepArrays a = arrays;
  const V cx = all(c[0]), cy = all(c[1]), ax = all(area[0]), ay = all(area[1]), dt = all(time_step);
  const V weight = all(coefficients.weight);
  const V same = all(coefficients.weight / (1 + coefficients.h1 * terms.rate));
  for_vectors(n, [&](int i, auto) CLOG_INLINE {
    V vx = load(a.vx + i), vy = load(a.vy + i);
    if constexpr (coupled) {
      V share = same;
      if constexpr (varying_rate) share = hn::Mul(weight, load(a.damping + i));
      V pull_x = cx, pull_y = cy;
      if constexpr (on_area) {
        pull_x = hn::NegMulAdd(load(a.grad_xx + i), ax, hn::NegMulAdd(load(a.grad_yx + i), ay, cx));
        pull_y = hn::NegMulAdd(load(a.grad_xy + i), ax, hn::NegMulAdd(load(a.grad_yy + i), ay, cy));
      }
      vx = hn::MulAdd(share, pull_x, vx);
      vy = hn::MulAdd(share, pull_y, vy);
    }
    store(vx, a.vx + i);
    store(vy, a.vy + i);
    store(hn::MulAdd(dt, vx, load(a.x + i)), a.x + i);
    store(hn::MulAdd(dt, vy, load(a.y + i)), a.y + i);
  });
  for (double* p : {a.x, a.y, a.vx, a.vy}) close(p, n);
}

void drift(int n, const KickTerms& terms, bool coupled, const KickCoefficients& coefficients,
           const double (&c)[2], const double (&area)[2], double dt, const StepArrays& arrays) {
  using Version = void (*)(int, const KickTerms&, const KickCoefficients&, const double(&)[2],
                           const double(&)[2], double, const StepArrays&);
  constexpr Version versions[2][2] = {{drift_with<true, false, false>, drift_with<true, false, true>},
                                      {drift_with<true, true, false>, drift_with<true, true, true>}};
  const Version version =
      coupled ? versions[terms.on_area][terms.varying_rate] : drift_with<false, false, false>;
  version(n, terms, coefficients, c, area, dt, arrays);
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
void near_wall_rates_with(int n, const NearWalls& walls, const NearWallDrag& drag, const StepArrays& arrays) {
  const StepArrays a = arrays;
  const V shortest = all(drag.shortest), power = all(-drag.exponent);
  const V far = all(drag.far_rate * drag.relative), near = all(drag.far_rate * drag.near_wall);
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
    store(hn::MulAdd(near, rise, far), a.rate + i);
  });
}

void near_wall_rates(int n, const NearWalls& walls, const NearWallDrag& drag, const StepArrays& arrays) {
  using Version = void (*)(int, const NearWalls&, const NearWallDrag&, const StepArrays&);
  constexpr Version versions[2][2] = {{near_wall_rates_with<false, false>, near_wall_rates_with<false, true>},
                                      {near_wall_rates_with<true, false>, near_wall_rates_with<true, true>}};
  versions[drag.exponent == 4.0 / 3][walls.alike](n, walls, drag, arrays);
}

/// Named as people call them.
const char* instruction_set_name() {
#if HWY_TARGET == HWY_AVX3
  return "avx512";
#elif HWY_TARGET == HWY_AVX2
  return "avx2";
#elif HWY_ARCH_X86
  return "baseline";
#else
  return hwy::TargetName(HWY_TARGET);
#endif
}

StepKernel make_kernel() {
  return {instruction_set_name(), measure, clear_pushes, push, kick, drift, near_wall_rates};
}

}  // namespace clog::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clog {
namespace kernel {

HWY_EXPORT(make_kernel);

StepKernel step_kernel() { return HWY_DYNAMIC_DISPATCH(make_kernel)(); }

namespace {

/// Lets the next step_kernel() choose among these targets; 0: all that the processor has.
void allow_targets(std::int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace
}  // namespace kernel

std::vector<std::string> instruction_sets() {
  const std::string present = instruction_set();
  std::vector<std::string> names;
  kernel::allow_targets(0);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    kernel::allow_targets(target);
    names.emplace_back(kernel::step_kernel().name);
  }
  use_instruction_set(present);
  return names;
}

std::string instruction_set() { return kernel::step_kernel().name; }

void use_instruction_set(const std::string& name) {
  kernel::allow_targets(0);
  if (name == "auto") return;
  std::string names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    kernel::allow_targets(target);
    if (kernel::step_kernel().name == name) return;
    names += std::string(", ") + kernel::step_kernel().name;
  }
  kernel::allow_targets(0);
  throw Error("this processor has no instruction set '" + name +
              "', or the program was not compiled for it; it has auto" + names);
}

}  // namespace clog
#endif

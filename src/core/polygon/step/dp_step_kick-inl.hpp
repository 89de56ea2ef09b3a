/// The first pass, which computes forces and velocities; part of dp_step_kernel.cpp.

#if defined(CLOG_DP_STEP_KICK) == defined(HWY_TARGET_TOGGLE)
#ifdef CLOG_DP_STEP_KICK
#undef CLOG_DP_STEP_KICK
#else
#define CLOG_DP_STEP_KICK
#endif

#include <type_traits>

#include "core/polygon/step/dp_step_vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
// NOLINTBEGIN(misc-definitions-in-headers): part of one source, compiled for each instruction set
namespace clog::kernel::HWY_NAMESPACE {

/// Sums for the coupled drag, where G is 6 a times the centroid's gradient, and s = 1/(1 + h r).
struct KickSums {
  double force_x, force_y;        ///< kick by the force on the area
  double w_x, w_y;                ///< sum of w
  double gw_x, gw_y;              ///< sum of G w
  double gg_xx, gg_xy, gg_yy;     ///< sum of s G G^T
  double s;                       ///< sum of s
  double g_xx, g_xy, g_yx, g_yy;  ///< sum of s G
  // The next members are for an implicit pressure; n is the chord turned outwards, twice the area's gradient.
  double nn = 0, nf = 0;      ///< sums of n.n and of n.F
  double ng_x = 0, ng_y = 0;  ///< sum of G n
};

/// Computes the coupled drag and the force on the area. The velocities after the kick are v_i = w_i + s_i (e
/// V - G_i^T (b V_a - R)),  V = mean v_i,  V_a = sum G_i v_i. Here s_i = 1/(1 + h r_i), and w_i is the
/// velocity after the kick by the force on the vertex and by its own drag. e and b are half a step times the
/// relative rate and the area rate. R is the kick by the force on the area. These are four linear equations
/// for V and V_a; the function eliminates V. The drag is implicit, because the drag on the area is stiff for
/// an elongated droplet: b sum |G_i|^2 grows with the square of the droplet's length and perimeter. An
/// implicit pressure adds H n_i to the kick, where n_i is the chord turned outwards: H = -q/(1 + q sum
/// n_j.n_j) (sum n_j.F_j + sum G_j n_j.(R - d V_a)). Here q is the softening, and d is half a step times the
/// area rate. R - d V_a is the kick by the force on the area and by the area's drag. The last factor is the
/// acceleration of the area.
template <bool implicit_pressure>
HWY_INLINE Coupling couple(int n, const KickTerms& terms, const AreaForce& force, const KickCoefficients& k,
                           const KickSums& sums) {
  const double one_nth = 1.0 / n;
  const double e = k.h1 * terms.relative_rate;
  const double feedback = 1 / (1 - e * one_nth * sums.s);
  const double pull = k.half_step * terms.relative_rate;
  double mean_x = one_nth * sums.w_x, mean_y = one_nth * sums.w_y;
  const double softening = k.softening / (1 + k.softening * sums.nn);
  double outwards = sums.nf;  // sum n.F with the force on the area
  Coupling result;
  if (terms.on_area) {
    const double unit = 1 / (6 * force.area);
    const double b = k.h1 * terms.area_rate * n;
    const double g_xx = unit * sums.g_xx, g_xy = unit * sums.g_xy;
    const double g_yx = unit * sums.g_yx, g_yy = unit * sums.g_yy;
    const double gg_xx = unit * unit * sums.gg_xx, gg_xy = unit * unit * sums.gg_xy;
    const double gg_yy = unit * unit * sums.gg_yy;
    const double kick_x = sums.force_x, kick_y = sums.force_y;
    const double before_x = k.closing_ratio * kick_x, before_y = k.closing_ratio * kick_y;
    mean_x += one_nth * (g_xx * before_x + g_yx * before_y);
    mean_y += one_nth * (g_xy * before_x + g_yy * before_y);
    const double both = e * feedback, both_b = both * b * one_nth;
    double right_x =
        unit * sums.gw_x + (gg_xx * before_x + gg_xy * before_y) + both * (g_xx * mean_x + g_xy * mean_y);
    double right_y =
        unit * sums.gw_y + (gg_xy * before_x + gg_yy * before_y) + both * (g_yx * mean_x + g_yy * mean_y);
    double m_xx = 1 + b * gg_xx + both_b * (g_xx * g_xx + g_xy * g_xy);
    double m_xy = b * gg_xy + both_b * (g_xx * g_yx + g_xy * g_yy);
    double m_yy = 1 + b * gg_yy + both_b * (g_yx * g_yx + g_yy * g_yy);
    const double drag = k.half_step * terms.area_rate * n;
    const double ng_x = unit * sums.ng_x, ng_y = unit * sums.ng_y;
    if constexpr (implicit_pressure) {
      outwards += ng_x * kick_x + ng_y * kick_y;
      // If s is the same for all vertices, the pressure moves the vertices by s n. The sum of these
      // displacements is zero.
      const double pressed = k.closing_ratio * softening * one_nth * sums.s;
      right_x -= pressed * ng_x * outwards;
      right_y -= pressed * ng_y * outwards;
      m_xx -= pressed * drag * ng_x * ng_x;
      m_xy -= pressed * drag * ng_x * ng_y;
      m_yy -= pressed * drag * ng_y * ng_y;
    }
    const double inverse = 1 / (m_xx * m_yy - m_xy * m_xy);
    result.area_x = inverse * (m_yy * right_x - m_xy * right_y);
    result.area_y = inverse * (m_xx * right_y - m_xy * right_x);
    if constexpr (implicit_pressure) outwards -= drag * (ng_x * result.area_x + ng_y * result.area_y);
    result.a_x = unit * (drag * result.area_x - kick_x);
    result.a_y = unit * (drag * result.area_y - kick_y);
    mean_x -= b * one_nth * (g_xx * result.area_x + g_yx * result.area_y);
    mean_y -= b * one_nth * (g_xy * result.area_x + g_yy * result.area_y);
  }
  result.mean_x = feedback * mean_x;
  result.mean_y = feedback * mean_y;
  result.c_x = pull * result.mean_x;
  result.c_y = pull * result.mean_y;
  if constexpr (implicit_pressure) result.half_pressure = -softening * outwards;
  return result;
}

/// Kick of a vertex by the springs along the interface, divided by the chord between the vertex's neighbours.
HWY_INLINE V spread_along_chord(V spreading, V length, V length_before, V tx, V tx_before, V ty,
                                V ty_before) {
  const V unevenness = hn::Div(hn::Sub(length, length_before), hn::Add(length, length_before));
  const V cosine = hn::Max(hn::MulAdd(tx, tx_before, hn::Mul(ty, ty_before)), all(0));
  return hn::Mul(hn::Mul(spreading, hn::Mul(cosine, cosine)), unevenness);
}

/// Lengths and tangents of the edges before and after each vertex of a vector.
struct Corner {
  V length, tx, ty, length_before, tx_before, ty_before;
  V ex, ey, ex_before, ey_before;

  /// The place of these products matters, because the compiler may fuse a product with the next sum, which
  /// changes the last bits.
  HWY_INLINE void multiply() {
    ex = hn::Mul(length, tx);
    ey = hn::Mul(length, ty);
    ex_before = hn::Mul(length_before, tx_before);
    ey_before = hn::Mul(length_before, ty_before);
  }
};

/// Forces along the interface, the same for all vertices.
struct InterfaceVectors {
  V line_tension, spring, spreading, half_pressure, vertex_weight;
};

/// Gradient of the area's centroid with respect to a vertex, times six times the area.
struct CentroidGradient {
  V xx, xy, yx, yy;
};

/// Computes G. A displacement of the vertex changes only the triangle of the vertex and its two neighbours,
/// so G = m n^T + k I. Here m is the sum of the three corners relative to the centroid, n the chord turned
/// outwards, and k twice the area of the triangle.
/// @param centre  three times the centroid
template <class Keep>
HWY_INLINE CentroidGradient centroid_gradient(const Pair& place, const Pair& centre, const Corner& corner,
                                              const Pair& chord, Keep keep) {
  const auto& [x, y] = place;
  const V minus_corners_x = hn::Add(hn::NegMulAdd(all(3), x, centre.x), hn::Sub(corner.ex_before, corner.ex));
  const V corners_y = hn::Add(hn::MulSub(all(3), y, centre.y), hn::Sub(corner.ey, corner.ey_before));
  const V twice_area = hn::MulSub(corner.ex_before, corner.ey, hn::Mul(corner.ey_before, corner.ex));
  return {keep(hn::NegMulAdd(minus_corners_x, chord.y, twice_area)), keep(hn::Mul(minus_corners_x, chord.x)),
          keep(hn::Mul(corners_y, chord.y)), keep(hn::NegMulAdd(corners_y, chord.x, twice_area))};
}

/// Sums over the vertices, for couple().
template <bool varying_rate>
struct KickVectors {
  V spread_x = all(0), spread_y = all(0);
  V w_x = all(0), w_y = all(0), gw_x = all(0), gw_y = all(0), gg_xx = all(0), gg_xy = all(0), gg_yy = all(0);
  V s_sum = all(0), g_xx = all(0), g_xy = all(0), g_yx = all(0), g_yy = all(0);
  V nn = all(0), nf = all(0), ng_x = all(0), ng_y = all(0);

  template <class Keep>
  HWY_INLINE void add_outwards(const Pair& chord, const Pair& force, Keep keep) {
    nn = hn::Add(nn, keep(hn::MulAdd(chord.x, chord.x, hn::Mul(chord.y, chord.y))));
    nf = hn::Add(nf, keep(hn::MulSub(chord.y, force.x, hn::Mul(chord.x, force.y))));
  }
  HWY_INLINE void add_outwards(const Pair& chord, const CentroidGradient& g) {
    ng_x = hn::MulAdd(g.xx, chord.y, hn::NegMulAdd(g.xy, chord.x, ng_x));
    ng_y = hn::MulAdd(g.yx, chord.y, hn::NegMulAdd(g.yy, chord.x, ng_y));
  }

  template <class Keep>
  HWY_INLINE void add_velocity(V s, const Pair& w, Keep keep) {
    if constexpr (varying_rate) {
      s_sum = hn::Add(s_sum, keep(s));
      w_x = hn::MulAdd(keep(s), w.x, w_x);
      w_y = hn::MulAdd(keep(s), w.y, w_y);
    } else {
      w_x = hn::Add(w_x, keep(w.x));
      w_y = hn::Add(w_y, keep(w.y));
    }
  }

  HWY_INLINE void add_gradient(const CentroidGradient& g, V s, const Pair& w) {
    CentroidGradient sg = g;
    if constexpr (varying_rate) {
      sg = {hn::Mul(s, g.xx), hn::Mul(s, g.xy), hn::Mul(s, g.yx), hn::Mul(s, g.yy)};
      g_xx = hn::Add(g_xx, sg.xx);
      g_xy = hn::Add(g_xy, sg.xy);
      g_yx = hn::Add(g_yx, sg.yx);
      g_yy = hn::Add(g_yy, sg.yy);
    }
    gw_x = hn::MulAdd(sg.xx, w.x, hn::MulAdd(sg.xy, w.y, gw_x));
    gw_y = hn::MulAdd(sg.yx, w.x, hn::MulAdd(sg.yy, w.y, gw_y));
    gg_xx = hn::MulAdd(sg.xx, g.xx, hn::MulAdd(sg.xy, g.xy, gg_xx));
    gg_xy = hn::MulAdd(sg.xx, g.yx, hn::MulAdd(sg.xy, g.yy, gg_xy));
    gg_yy = hn::MulAdd(sg.yx, g.yx, hn::MulAdd(sg.yy, g.yy, gg_yy));
  }

  /// @param one_s  s, if it is the same for all vertices. The sums do not contain this factor yet.
  template <bool implicit_pressure>
  HWY_INLINE KickSums total(int n, const AreaForce& force, double one_s) const {
    const auto w = sums(w_x, w_y, spread_x, spread_y);
    const auto gw = sums(gw_x, gw_y, gg_xx, gg_xy);
    KickSums total{.force_x = force.x - w[2],
                   .force_y = force.y - w[3],
                   .w_x = one_s * w[0],
                   .w_y = one_s * w[1],
                   .gw_x = one_s * gw[0],
                   .gw_y = one_s * gw[1],
                   .gg_xx = one_s * gw[2],
                   .gg_xy = one_s * gw[3],
                   .gg_yy = one_s * sum(gg_yy),
                   .s = n * one_s,
                   .g_xx = 6 * force.area * one_s,
                   .g_xy = 0,
                   .g_yx = 0,
                   .g_yy = 6 * force.area * one_s};
    if constexpr (varying_rate) {
      const auto g = sums(g_xx, g_xy, g_yx, g_yy);
      total.g_xx = g[0];
      total.g_xy = g[1];
      total.g_yx = g[2];
      total.g_yy = g[3];
      total.s = sum(s_sum);
    }
    if constexpr (implicit_pressure) {
      const auto outwards = sums(nn, nf, ng_x, ng_y);
      total.nn = outwards[0];
      total.nf = outwards[1];
      total.ng_x = outwards[2];
      total.ng_y = outwards[3];
    }
    return total;
  }
};

/// The force on vertices, without the drag.
template <bool elastic, bool on_area, bool varying_rate, class Keep>
HWY_INLINE Pair kick_force(const Corner& c, const Pair& chord, const Pair& push,
                           const InterfaceVectors& along, KickVectors<varying_rate>& total, Keep keep) {
  // Slow operations come first, because the processor reorders only nearby instructions.
  V spread;
  if constexpr (!elastic)
    spread = keep(
        spread_along_chord(along.spreading, c.length, c.length_before, c.tx, c.tx_before, c.ty, c.ty_before));
  V fx = hn::MulAdd(along.half_pressure, chord.y, push.x);
  V fy = hn::NegMulAdd(along.half_pressure, chord.x, push.y);
  if constexpr (elastic) {
    const V pull = hn::MulAdd(along.spring, c.length, along.line_tension);
    const V pull_before = hn::MulAdd(along.spring, c.length_before, along.line_tension);
    fx = hn::MulAdd(pull, c.tx, hn::NegMulAdd(pull_before, c.tx_before, fx));
    fy = hn::MulAdd(pull, c.ty, hn::NegMulAdd(pull_before, c.ty_before, fy));
  } else {
    fx = hn::MulAdd(along.line_tension, hn::Sub(c.tx, c.tx_before), fx);
    fy = hn::MulAdd(along.line_tension, hn::Sub(c.ty, c.ty_before), fy);
    fx = hn::MulAdd(spread, chord.x, fx);
    fy = hn::MulAdd(spread, chord.y, fy);
    total.spread_x = hn::MulAdd(spread, chord.x, total.spread_x);
    total.spread_y = hn::MulAdd(spread, chord.y, total.spread_y);
  }
  if constexpr (!on_area) fx = hn::Add(fx, along.vertex_weight);
  return {fx, fy};
}

template <bool elastic, bool coupled, bool on_area, bool varying_rate, bool implicit_pressure>
Coupling kick_with(int n, const KickTerms& terms, const InterfaceKick& interface, const AreaForce& force,
                   const KickCoefficients& coefficients, const StepArrays& arrays) {
  const StepArrays a = arrays;  // a local copy: the compiler knows that stores do not change it
  const InterfaceVectors along{all(interface.line_tension), all(interface.spring), all(interface.spreading),
                               all(interface.half_pressure), all(interface.vertex_weight)};
  const Pair centre{all(3 * force.centre_x), all(3 * force.centre_y)};
  const V closing_ratio = all(coefficients.closing_ratio);
  const bool keeps_kicked = coefficients.keeps_kicked;
  const double one_s = varying_rate ? 1 : 1 / (1 + coefficients.h1 * terms.rate);
  const V same_s = all(one_s), same_kept = all(one_s * (1 - coefficients.h2 * terms.rate));
  KickVectors<varying_rate> total{};  // an aggregate: constructors are not compiled for the instruction set
  Corner last;
  last.length = all(a.length[-1]);
  last.tx = all(a.tangent.x[-1]);
  last.ty = all(a.tangent.y[-1]);
  for_vectors(n, [&](int i, auto keep) CLOG_INLINE {
    Corner corner;
    corner.length = load(a.length + i);
    corner.tx = load(a.tangent.x + i);
    corner.ty = load(a.tangent.y + i);
    corner.length_before = shifted_back<1>(a.length + i, last.length, corner.length);
    corner.tx_before = shifted_back<1>(a.tangent.x + i, last.tx, corner.tx);
    corner.ty_before = shifted_back<1>(a.tangent.y + i, last.ty, corner.ty);
    last = corner;
    corner.multiply();
    // The chord between the vertex's neighbours; (y, -x) is the chord turned outwards.
    const Pair chord{hn::Add(corner.ex, corner.ex_before), hn::Add(corner.ey, corner.ey_before)};
    const auto [fx, fy] = kick_force<elastic, on_area>(corner, chord, load(a.push, i), along, total, keep);
    // If s is the same for all vertices, the sums are multiplied by s at the end.
    const Pair before = load(a.velocity, i);
    const Pair w{hn::MulAdd(closing_ratio, fx, before.x), hn::MulAdd(closing_ratio, fy, before.y)};
    V s = same_s, kept = same_kept;
    if constexpr (varying_rate) {
      s = load(a.damping + i);
      kept = load(a.kept + i);
    }
    store({hn::MulAdd(w.x, kept, fx), hn::MulAdd(w.y, kept, fy)}, a.velocity, i);
    if (keeps_kicked) store({hn::Mul(w.x, s), hn::Mul(w.y, s)}, a.kicked, i);
    if constexpr (coupled) total.add_velocity(s, w, keep);
    if constexpr (implicit_pressure) {
      total.add_outwards(chord, {fx, fy}, keep);
      store(chord, a.chord, i);
    }
    if constexpr (on_area) {
      const CentroidGradient g = centroid_gradient(load(a.position, i), centre, corner, chord, keep);
      store({g.xx, g.xy}, a.grad_x, i);
      store({g.yx, g.yy}, a.grad_y, i);
      total.add_gradient(g, s, w);
      if constexpr (implicit_pressure) total.add_outwards(chord, g);
    }
  });
  if constexpr (!coupled && !implicit_pressure) return {};
  return couple<implicit_pressure>(n, terms, force, coefficients,
                                   total.template total<implicit_pressure>(n, force, one_s));
}

/// Calls make() with the terms of a kick as compile-time constants: elastic, coupled, on_area, varying_rate,
/// implicit_pressure. With implicit_pressure, rates are always constant.
template <class Make>
auto version(const KickTerms& terms, Make make) {
  constexpr std::true_type yes;
  constexpr std::false_type no;
  const auto of_drag = [&](auto... chosen) {
    if (terms.varying_rate) return make(chosen..., yes, no);
    return terms.implicit_pressure ? make(chosen..., no, yes) : make(chosen..., no, no);
  };
  const auto of_coupling = [&](auto elastic) {
    if (!terms.coupled) return of_drag(elastic, no, no);
    return terms.on_area ? of_drag(elastic, yes, yes) : of_drag(elastic, yes, no);
  };
  return terms.elastic ? of_coupling(yes) : of_coupling(no);
}

decltype(StepKernel::kick) kick_version(const KickTerms& terms) {
  return version(terms, [](auto... chosen) { return &kick_with<chosen...>; });
}

}  // namespace clog::kernel::HWY_NAMESPACE
// NOLINTEND(misc-definitions-in-headers)
HWY_AFTER_NAMESPACE();
#endif

/// The second pass, which computes positions and edges, and the survey between steps; part of
/// dp_step_kernel.cpp.

#if defined(CLOG_DP_STEP_DRIFT) == defined(HWY_TARGET_TOGGLE)
#ifdef CLOG_DP_STEP_DRIFT
#undef CLOG_DP_STEP_DRIFT
#else
#define CLOG_DP_STEP_DRIFT
#endif

#include <cmath>

#include "core/polygon/step/dp_step_kick-inl.hpp"

HWY_BEFORE_NAMESPACE();
// NOLINTBEGIN(misc-definitions-in-headers): part of one source, compiled for each instruction set
namespace clog::kernel::HWY_NAMESPACE {

/// Fills the edges, a vector at a time, and adds up the requested sums.
template <bool with_perimeter, bool with_moments>
struct EdgeMeasure {
  StepArrays a;
  V perimeter = all(0), twice_area = all(0), moment_x = all(0), moment_y = all(0);

  template <class Keep>
  HWY_INLINE void add(int i, V x, V y, V next_x, V next_y, Keep keep) {
    const V ex = hn::Sub(next_x, x), ey = hn::Sub(next_y, y);
    const V length2 = hn::MulAdd(ex, ex, hn::Mul(ey, ey));
    const auto [length, inverse_length] = square_root(length2);
    const V cross = keep(hn::MulSub(x, ey, hn::Mul(y, ex)));
    store(hn::Mul(ex, inverse_length), a.tangent.x + i);
    store(hn::Mul(ey, inverse_length), a.tangent.y + i);
    store(length, a.length + i);
    twice_area = hn::Add(twice_area, cross);
    if constexpr (with_perimeter) perimeter = hn::Add(perimeter, keep(length));
    if constexpr (with_moments) {
      moment_x = hn::MulAdd(cross, hn::Add(x, next_x), moment_x);
      moment_y = hn::MulAdd(cross, hn::Add(y, next_y), moment_y);
    }
  }

  HWY_INLINE Sums total(int n) const {
    for (const ContourArray& p : {a.tangent.x, a.tangent.y, a.length}) p[-1] = p[n - 1];
    const auto s = sums(twice_area, perimeter, moment_x, moment_y);
    return {s[0] / 2, s[1], s[2] / 6, s[3] / 6};
  }
};

Sums measure(int n, const StepArrays& arrays) {
  EdgeMeasure<true, true> edges{arrays};
  const StepArrays& a = arrays;
  for_vectors(n, [&](int i, auto keep) CLOG_INLINE {
    edges.add(i, load(a.position.x + i), load(a.position.y + i), load_at(a.position.x + i + 1),
              load_at(a.position.y + i + 1), keep);
  });
  return edges.total(n);
}

HWY_INLINE V square(V x, V y) { return hn::MulAdd(x, x, hn::Mul(y, y)); }

HWY_INLINE double root_of_largest(V v) { return std::sqrt(hn::GetLane(hn::MaxOfLanes(D(), v))); }

Survey survey(int n, const double* walls, const double* self, const StepArrays& arrays) {
  const StepArrays a = arrays;
  V speed2 = all(0), moved2 = all(0), perimeter = all(0), shortest = all(1e300);
  V sum_x = all(0), sum_y = all(0), sum_vx = all(0), sum_vy = all(0);
  for_vectors(n, [&](int i, auto keep) CLOG_INLINE {
    const V x = load(a.position.x + i), y = load(a.position.y + i), vx = load(a.velocity.x + i),
            vy = load(a.velocity.y + i);
    const V length = load(a.length + i);
    sum_x = hn::Add(sum_x, keep(x));
    sum_y = hn::Add(sum_y, keep(y));
    sum_vx = hn::Add(sum_vx, keep(vx));
    sum_vy = hn::Add(sum_vy, keep(vy));
    speed2 = hn::Max(speed2, keep(square(vx, vy)));
    perimeter = hn::Add(perimeter, keep(length));
    // The entries beyond the last edge have length 0, and are excluded.
    shortest = hn::Min(shortest, hn::IfThenElse(hn::Gt(keep(all(1)), all(0)), length, all(1e300)));
    if (walls != nullptr) {
      const V dx = hn::Sub(x, load_at(walls + i)), dy = hn::Sub(y, load_at(walls + n + i));
      moved2 = hn::Max(moved2, keep(square(dx, dy)));
    }
  });
  const auto mean = sums(sum_x, sum_y, sum_vx, sum_vy);
  const V x0 = all(mean[0] / n), y0 = all(mean[1] / n), vx0 = all(mean[2] / n), vy0 = all(mean[3] / n);
  V relative_speed2 = all(0), relative_moved2 = all(0);
  for_vectors(n, [&](int i, auto keep) CLOG_INLINE {
    const V vx = hn::Sub(load(a.velocity.x + i), vx0), vy = hn::Sub(load(a.velocity.y + i), vy0);
    relative_speed2 = hn::Max(relative_speed2, keep(square(vx, vy)));
    if (self != nullptr) {
      const V dx = hn::Sub(hn::Sub(load(a.position.x + i), x0), load_at(self + i));
      const V dy = hn::Sub(hn::Sub(load(a.position.y + i), y0), load_at(self + n + i));
      relative_moved2 = hn::Max(relative_moved2, keep(square(dx, dy)));
    }
  });
  return {.perimeter = sum(perimeter),
          .shortest = hn::GetLane(hn::MinOfLanes(D(), shortest)),
          .speed = root_of_largest(speed2),
          .relative_speed = root_of_largest(relative_speed2),
          .moved = root_of_largest(moved2),
          .moved_relative = root_of_largest(relative_moved2)};
}

/// Terms that act on all vertices, see Coupling.
struct CouplingVectors {
  Pair c, a;
  V pressure;

  HWY_INLINE explicit CouplingVectors(const Coupling& k)
      : c{all(k.c_x), all(k.c_y)}, a{all(k.a_x), all(k.a_y)}, pressure(all(k.half_pressure)) {}
  /// c - G^T a plus the term of an implicit pressure.
  HWY_INLINE Pair pull(int i, bool on_area, bool implicit_pressure, const StepArrays& arrays) const {
    Pair pull = c;
    if (on_area) {
      const Pair of_x = load(arrays.grad_x, i), of_y = load(arrays.grad_y, i);
      pull.x = hn::NegMulAdd(of_x.x, a.x, hn::NegMulAdd(of_y.x, a.y, c.x));
      pull.y = hn::NegMulAdd(of_x.y, a.x, hn::NegMulAdd(of_y.y, a.y, c.y));
    }
    if (implicit_pressure) {
      const Pair chord = load(arrays.chord, i);
      pull.x = hn::MulAdd(pressure, chord.y, pull.x);
      pull.y = hn::NegMulAdd(pressure, chord.x, pull.y);
    }
    return pull;
  }
};

template <bool elastic, bool coupled, bool on_area, bool varying_rate, bool implicit_pressure>
Power power_with(int n, const KickTerms& terms, const InterfaceKick& interface,
                 const KickCoefficients& coefficients, const Coupling& coupling, const StepArrays& arrays) {
  const StepArrays a = arrays;
  const double one_s =
      coefficients.closing_ratio / (1 + coefficients.h1 * terms.rate);  // 0: w is the velocity
  const CouplingVectors all_vertices(coupling);
  const V same_s = all(one_s), same_rate = all(terms.rate), closing_ratio = all(coefficients.closing_ratio);
  const V spreading = all(interface.spreading);
  V drag = all(0), spread_power = all(0), spread_x = all(0), spread_y = all(0);
  for_vectors(n, [&](int i, auto keep) CLOG_INLINE {
    V s = same_s, rate = same_rate;
    if constexpr (varying_rate) {
      s = hn::Mul(closing_ratio, load(a.damping + i));
      rate = load(a.rate + i);
    }
    V vx = load(a.kicked.x + i), vy = load(a.kicked.y + i);
    if constexpr (coupled || implicit_pressure) {
      const Pair pull = all_vertices.pull(i, on_area, implicit_pressure, a);
      vx = hn::MulAdd(s, pull.x, vx);
      vy = hn::MulAdd(s, pull.y, vy);
    }
    drag = hn::Add(drag, keep(hn::Mul(rate, hn::MulAdd(vx, vx, hn::Mul(vy, vy)))));
    if constexpr (elastic) return;
    const V length = load(a.length + i), length_before = load_at(a.length + i - 1);
    const V tx = load(a.tangent.x + i), tx_before = load_at(a.tangent.x + i - 1);
    const V ty = load(a.tangent.y + i), ty_before = load_at(a.tangent.y + i - 1);
    const V spread = keep(spread_along_chord(spreading, length, length_before, tx, tx_before, ty, ty_before));
    const V chord_x = hn::MulAdd(length, tx, hn::Mul(length_before, tx_before));
    const V chord_y = hn::MulAdd(length, ty, hn::Mul(length_before, ty_before));
    const V fx = hn::MulAdd(spread, chord_x, keep(load(a.wetting.x + i)));
    const V fy = hn::MulAdd(spread, chord_y, keep(load(a.wetting.y + i)));
    spread_power = hn::MulAdd(fx, vx, hn::MulAdd(fy, vy, spread_power));
    spread_x = hn::Add(spread_x, fx);
    spread_y = hn::Add(spread_y, fy);
  });
  const auto s = sums(drag, spread_power, spread_x, spread_y);
  return {.drag = s[0], .spreading = s[1], .spread_x = s[2], .spread_y = s[3]};
}

decltype(StepKernel::power) power_version(const KickTerms& terms) {
  return version(terms, [](auto... chosen) { return &power_with<chosen...>; });
}

template <bool elastic, bool coupled, bool on_area, bool varying_rate, bool implicit_pressure>
Sums drift_with(int n, const KickTerms& terms, const KickCoefficients& coefficients, const Coupling& coupling,
                double time_step, const StepArrays& arrays) {
  const StepArrays a = arrays;
  const CouplingVectors all_vertices(coupling);
  const V dt = all(time_step), weight = all(coefficients.weight);
  const V same = all(coefficients.weight / (1 + coefficients.h1 * terms.rate));
  const auto move = [&](int i) CLOG_INLINE {
    Pair v = load(a.velocity, i);
    if constexpr (coupled || implicit_pressure) {
      V share = same;
      if constexpr (varying_rate) share = hn::Mul(weight, load(a.damping + i));
      const Pair pull = all_vertices.pull(i, on_area, implicit_pressure, a);
      v = {hn::MulAdd(share, pull.x, v.x), hn::MulAdd(share, pull.y, v.y)};
      store(v, a.velocity, i);
    }
    const Pair from = load(a.position, i);
    const Pair to{hn::MulAdd(dt, v.x, from.x), hn::MulAdd(dt, v.y, from.y)};
    store(to, a.position, i);
    return to;
  };
  EdgeMeasure<elastic, on_area> edges{a};
  // The loop handles edges one vector behind the vertices, so that the processor works on both at once.
  const Pair first = move(0);
  Pair here = first, next = n > lanes ? move(lanes) : first;
  int i = 0;
  const auto measure_behind = [&]() CLOG_INLINE {
    edges.add(i, here.x, here.y, shifted_forward(here.x, next.x), shifted_forward(here.y, next.y), KeepAll());
    here = next;
    i += lanes;
  };
  while (i + 2 * lanes < n) {
    const Pair after = move(i + 2 * lanes);
    measure_behind();
    next = after;
  }
  if (i + lanes < n) measure_behind();
  close(a.position.x, n);
  close(a.position.y, n);
  if (i + lanes == n)
    edges.add(i, here.x, here.y, shifted_forward(here.x, first.x), shifted_forward(here.y, first.y),
              KeepAll());
  else
    edges.add(i, load(a.position.x + i), load(a.position.y + i), load_at(a.position.x + i + 1),
              load_at(a.position.y + i + 1), KeepFirst(n - i));
  return edges.total(n);
}

decltype(StepKernel::drift) drift_version(const KickTerms& terms) {
  return version(terms, [](auto... chosen) { return &drift_with<chosen...>; });
}

}  // namespace clog::kernel::HWY_NAMESPACE
// NOLINTEND(misc-definitions-in-headers)
HWY_AFTER_NAMESPACE();
#endif

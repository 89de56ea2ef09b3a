/// Operations on vectors of a contour, for the instruction set that is being compiled; part of
/// dp_step_kernel.cpp.

#if defined(CLOG_DP_STEP_VECTORS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLOG_DP_STEP_VECTORS
#undef CLOG_DP_STEP_VECTORS
#else
#define CLOG_DP_STEP_VECTORS
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/polygon/step/dp_step_kernel.hpp"

HWY_BEFORE_NAMESPACE();
namespace clog::kernel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, edges_per_group>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

constexpr int lanes = static_cast<int>(MaxLanes(D()));

HWY_INLINE V load(const double* p) { return hn::Load(D(), p); }
HWY_INLINE V load_at(const double* p) { return hn::LoadU(D(), p); }
HWY_INLINE void store(V v, double* p) { hn::Store(v, D(), p); }
HWY_INLINE V all(double value) { return hn::Set(D(), value); }

/// An x and a y for each lane.
struct Pair {
  V x, y;
};
HWY_INLINE Pair load(const ContourPair& p, std::ptrdiff_t i) { return {load(p.x + i), load(p.y + i)}; }
HWY_INLINE Pair load_at(const ContourPair& p, std::ptrdiff_t i) {
  return {load_at(p.x + i), load_at(p.y + i)};
}
HWY_INLINE void store(Pair v, const ContourPair& p, std::ptrdiff_t i) {
  store(v.x, p.x + i);
  store(v.y, p.y + i);
}

HWY_INLINE double sum(V v) { return hn::GetLane(hn::SumOfLanes(D(), v)); }

/// The sums over the lanes of four vectors. This takes only as long as two separate sums.
HWY_INLINE std::array<double, 4> sums(V a, V b, V c, V d) {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX2
  const V ab = hn::Add(hn::InterleaveLower(D(), a, b), hn::InterleaveUpper(D(), a, b));
  const V cd = hn::Add(hn::InterleaveLower(D(), c, d), hn::InterleaveUpper(D(), c, d));
  const V abcd = hn::Add(hn::ConcatLowerLower(D(), cd, ab), hn::ConcatUpperUpper(D(), cd, ab));
  alignas(64) std::array<double, lanes> s;
#if HWY_TARGET == HWY_AVX3
  store(hn::Add(abcd, hn::SwapAdjacentBlocks(abcd)), s.data());
  return {s[0], s[1], s[4], s[5]};
#else
  store(abcd, s.data());
  return s;
#endif
#else
  return {sum(a), sum(b), sum(c), sum(d)};
#endif
}

/// The vector that begins `num` entries before p. `before` and `here` are the vectors at p - lanes and p.
/// This function uses them, so that two cache lines need not be read again.
template <int num>
HWY_INLINE V shifted_back([[maybe_unused]] const double* p, [[maybe_unused]] V before,
                          [[maybe_unused]] V here) {
#if HWY_TARGET == HWY_AVX3
  const __m512i joined =
      _mm512_alignr_epi64(_mm512_castpd_si512(here.raw), _mm512_castpd_si512(before.raw), lanes - num);
  return V{_mm512_castsi512_pd(joined)};
#else
  return load_at(p - num);
#endif
}

/// Moves every lane to the preceding lane, and the first lane of `next` to the last lane.
HWY_INLINE V shifted_forward([[maybe_unused]] V here, V next) {
#if HWY_TARGET == HWY_AVX3
  const __m512i joined = _mm512_alignr_epi64(_mm512_castpd_si512(next.raw), _mm512_castpd_si512(here.raw), 1);
  return V{_mm512_castsi512_pd(joined)};
#elif HWY_TARGET == HWY_AVX2
  return hn::CombineShiftRightBytes<8>(D(), hn::ConcatLowerUpper(D(), next, here), here);
#elif HWY_TARGET == HWY_SCALAR
  return next;
#else
  static_assert(lanes == 2, "the shift stays within a block of 16 bytes");
  return hn::CombineShiftRightBytes<8>(D(), next, here);
#endif
}

/// sqrt(v) and 1/sqrt(v); the last bit or two may be wrong.
struct Root {
  V root, inverse;
};
HWY_INLINE Root square_root(V v) {
#if HWY_TARGET == HWY_AVX3
  // The first guess has 14 bits. The first terms of (1 - error)^(-1/2) correct it.
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

/// 1/v; the last bit or two may be wrong. A division of eight numbers would keep the divider busy for 16
/// cycles.
HWY_INLINE V reciprocal(V v) {
#if HWY_TARGET == HWY_AVX3
  // The first guess has 14 bits. 1/(1 - error) = (1 + error) (1 + error^2) (1 + error^4) ... corrects it.
  const V guess{_mm512_rcp14_pd(v.raw)};
  const V error = hn::NegMulAdd(v, guess, all(1));
  const V better = hn::MulAdd(guess, error, guess);
  return hn::MulAdd(better, hn::Mul(error, error), better);
#else
  return hn::Div(all(1), v);
#endif
}

/// Rounds towards zero. The numbers must fit into integers.
HWY_INLINE hn::Vec<hn::RebindToSigned<D>> truncated(V v) {
#if HWY_TARGET == HWY_AVX3
  return hn::Vec<hn::RebindToSigned<D>>{
      _mm512_cvttpd_epi64(v.raw)};  // Highway's version also handles numbers that do not fit
#else
  return hn::ConvertTo(hn::RebindToSigned<D>(), v);
#endif
}

/// Makes the bodies of for_vectors() inline. Otherwise their sums would be in memory, which is slow.
#undef CLOG_INLINE
#if defined(__GNUC__)
#define CLOG_INLINE __attribute__((always_inline))
#else
#define CLOG_INLINE
#endif

/// Keeps all lanes, for a vector that ends at or before the last vertex.
struct KeepAll {
  HWY_INLINE V operator()(V v) const { return v; }
};
/// Zeroes the lanes beyond the last vertex.
struct KeepFirst {
  M inside;
  explicit KeepFirst(int count) : inside(hn::FirstN(D(), static_cast<std::size_t>(count))) {}
  HWY_INLINE V operator()(V v) const { return hn::IfThenElseZero(inside, v); }
};

/// Calls body(i, keep) for every vector of the contour.
template <class Body>
HWY_INLINE void for_vectors(int n, Body body) {
  int i = 0;
  for (; i + lanes <= n; i += lanes) body(i, KeepAll());
  if (i < n) body(i, KeepFirst(n - i));
}

/// Repeats the contour beyond its ends.
HWY_INLINE void close(const ContourArray& p, int n) {
  p[-1] = p[n - 1];
  for (int k = 0; k < edges_per_group; k += lanes) hn::StoreU(load(p + k), D(), p + n + k);
}

}  // namespace clog::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

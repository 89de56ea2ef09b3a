#include "touch_kernel.hpp"

#include "clog/core/droplet/shape.hpp"
#include "core/tools/vector_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/polygon/contact/touch_kernel.cpp"
#include <hwy/foreach_target.h>
// The targets' code follows.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace clog::kernel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, GroupTouches::edges>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

constexpr int lanes = static_cast<int>(MaxLanes(D()));

HWY_INLINE V all(double value) { return hn::Set(D(), value); }
HWY_INLINE V load_at(const double* p) { return hn::LoadU(D(), p); }

struct Vectors {
  V x, y;
  HWY_INLINE V square() const { return hn::Add(hn::Mul(x, x), hn::Mul(y, y)); }
};
HWY_INLINE Vectors operator-(const Vectors& a, const Vectors& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y)};
}
HWY_INLINE Vectors operator+(const Vectors& a, const Vectors& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y)};
}
HWY_INLINE Vectors operator*(V factor, const Vectors& v) {
  return {hn::Mul(factor, v.x), hn::Mul(factor, v.y)};
}

/// Half edges in contact with a circle. Each half edge leads from a vertex to the middle of its edge.
/// NearestOnHalves in dp_step_circles-inl.hpp computes the closest points faster.
struct Half {
  M touches;
  V length;
  V to_middle;  ///< fraction of the force that acts on the middle
  Vectors push;

  HWY_INLINE Half(const Vectors& vertex, const Vectors& middle, const Vectors& centre, V reach, V stiffness) {
    const Vectors edge = middle - vertex, to_centre = centre - vertex;
    const V length2 = edge.square(), zero = all(0), one = all(1);
    const M is_long = hn::Gt(length2, zero);
    const V dot = hn::Add(hn::Mul(edge.x, to_centre.x), hn::Mul(edge.y, to_centre.y));
    const V along = hn::IfThenElseZero(is_long, hn::Min(hn::Max(hn::Div(dot, length2), zero), one));
    const Vectors nearest = vertex + along * edge, from_centre = nearest - centre;
    const V distance = hn::Sqrt(from_centre.square());
    const V overlap = hn::Sub(reach, distance);
    touches = hn::And(hn::Gt(overlap, zero), hn::Gt(distance, zero));
    length = hn::Sqrt(length2);
    to_middle = hn::IfThenElseZero(is_long, hn::Div(hn::Sqrt((nearest - vertex).square()), length));
    push = hn::Div(hn::Mul(stiffness, overlap), distance) * from_centre;
  }
};

void touch(const double* x, const double* y, const Circle& circle, double stiffness, GroupTouches& touches) {
  const Vectors centre{all(circle.x), all(circle.y)};
  const V reach = all(circle.reach), zero = all(0);
  const V far = all(refined_far), near = all(refined_near);
  touches.touching = 0;
  for (int i = 0; i < GroupTouches::edges; i += lanes) {
    const auto vertices = [&](int k) { return Vectors{load_at(x + i + k), load_at(y + i + k)}; };
    const Vectors begin = vertices(0), end = vertices(1);
    const Vectors middle = far * vertices(-1) + near * begin + near * end + far * vertices(2);
    // No point of a half edge is farther from its vertex than the length of the half edge.
    const V first_way = hn::Sqrt((middle - begin).square()), second_way = hn::Sqrt((middle - end).square());
    const auto may_touch = [&](const Vectors& vertex, V way) {
      const V farthest = hn::Add(reach, way);
      return hn::Le((vertex - centre).square(), hn::Mul(farthest, farthest));
    };
    if (hn::AllFalse(D(), hn::Or(may_touch(begin, first_way), may_touch(end, second_way)))) continue;
    const Half first(begin, middle, centre, reach, all(stiffness));
    const Half second(end, middle, centre, reach, all(stiffness));
    const M any = hn::Or(first.touches, second.touches);
    if (hn::AllFalse(D(), any)) continue;
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(D(), any, bits);
    touches.touching |= static_cast<unsigned>(bits[0]) << i;

    // Adds the forces in the order of the half edges. For each half edge, adds the force on its own vertex
    // first.
    const auto if_touches = [](const Half& half, V share) {
      return Vectors{hn::IfThenElseZero(half.touches, hn::Mul(share, half.push.x)),
                     hn::IfThenElseZero(half.touches, hn::Mul(share, half.push.y))};
    };
    const auto by_middle = [&](const Half& half, V share) {
      return if_touches(half, hn::Mul(half.to_middle, share));
    };
    const auto own = [&](const Half& half) { return if_touches(half, hn::Sub(all(1), half.to_middle)); };
    const auto keep = [&](int k, const Vectors& push) {
      hn::Store(push.x, D(), touches.push_x[k] + i);
      hn::Store(push.y, D(), touches.push_y[k] + i);
    };
    keep(0, by_middle(first, far) + by_middle(second, far));
    keep(1, own(first) + by_middle(first, near) + by_middle(second, near));
    keep(2, by_middle(first, near) + own(second) + by_middle(second, near));
    keep(3, by_middle(first, far) + by_middle(second, far));
    // A half edge in contact is wetted over its whole length. The part of this length next to the edge's
    // middle is divided between both vertices.
    const auto wetted = [&](double by_first, double by_second, double* p) {
      hn::Store(hn::Add(hn::IfThenElse(first.touches, hn::Mul(all(by_first), first.length), zero),
                        hn::IfThenElse(second.touches, hn::Mul(all(by_second), second.length), zero)),
                D(), p + i);
    };
    wetted(0.75, 0.25, touches.wetted[0]);
    wetted(0.25, 0.75, touches.wetted[1]);
  }
}

void directions(std::size_t n, const double* x, const double* y, const double* numerators,
                double* direction_x, double* direction_y, double* ratios) {
  for (std::size_t i = 0; i < n; i += lanes) {
    const Vectors v{load_at(x + i), load_at(y + i)};
    const V length = hn::Sqrt(v.square());
    hn::StoreU(hn::Div(v.x, length), D(), direction_x + i);
    hn::StoreU(hn::Div(v.y, length), D(), direction_y + i);
    hn::StoreU(hn::Div(load_at(numerators + i), length), D(), ratios + i);
  }
}

TouchKernel make_kernel() { return {touch, directions}; }

}  // namespace clog::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clog::kernel {

HWY_EXPORT(make_kernel);

TouchKernel touch_kernel() { return HWY_DYNAMIC_DISPATCH(make_kernel)(); }

}  // namespace clog::kernel
#endif

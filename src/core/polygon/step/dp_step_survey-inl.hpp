/// What the checks between steps need to know; part of dp_step_kernel.cpp.

#if defined(CLOG_DP_STEP_SURVEY) == defined(HWY_TARGET_TOGGLE)
#ifdef CLOG_DP_STEP_SURVEY
#undef CLOG_DP_STEP_SURVEY
#else
#define CLOG_DP_STEP_SURVEY
#endif

#include <cmath>

#include "core/polygon/step/dp_step_vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
// NOLINTBEGIN(misc-definitions-in-headers): part of one source, compiled for each instruction set
namespace clog::kernel::HWY_NAMESPACE {

HWY_INLINE V square(V x, V y) { return hn::MulAdd(x, x, hn::Mul(y, y)); }

HWY_INLINE double root_of_largest(V v) { return std::sqrt(hn::GetLane(hn::MaxOfLanes(D(), v))); }

Survey survey(int n, const double* walls, const double* self, const StepArrays& arrays) {
  const StepArrays a = arrays;
  V speed2 = all(0), moved2 = all(0), perimeter = all(0), shortest = all(1e300);
  V sum_x = all(0), sum_y = all(0), sum_vx = all(0), sum_vy = all(0);
  for_vectors(n, [&](int i, auto keep) CLOG_INLINE {
    const V x = load(a.x + i), y = load(a.y + i), vx = load(a.vx + i), vy = load(a.vy + i);
    const V length = load(a.length + i);
    sum_x = hn::Add(sum_x, keep(x));
    sum_y = hn::Add(sum_y, keep(y));
    sum_vx = hn::Add(sum_vx, keep(vx));
    sum_vy = hn::Add(sum_vy, keep(vy));
    speed2 = hn::Max(speed2, keep(square(vx, vy)));
    perimeter = hn::Add(perimeter, keep(length));
    // Zero lengths behind the last edge do not count.
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
    const V vx = hn::Sub(load(a.vx + i), vx0), vy = hn::Sub(load(a.vy + i), vy0);
    relative_speed2 = hn::Max(relative_speed2, keep(square(vx, vy)));
    if (self != nullptr) {
      const V dx = hn::Sub(hn::Sub(load(a.x + i), x0), load_at(self + i));
      const V dy = hn::Sub(hn::Sub(load(a.y + i), y0), load_at(self + n + i));
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

}  // namespace clog::kernel::HWY_NAMESPACE
// NOLINTEND(misc-definitions-in-headers)
HWY_AFTER_NAMESPACE();
#endif

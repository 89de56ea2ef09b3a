#include "clog/core/droplet/fire.hpp"

#include <algorithm>
#include <cmath>

#include "core/tools/vector_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/droplet/fire.cpp"
#include <hwy/foreach_target.h>
// The loops use no vector types; Highway compiles them for each of its targets.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace clog::kernel::HWY_NAMESPACE {

ForceSums sum_forces(std::ptrdiff_t n, const double* __restrict force, const double* __restrict velocity) {
  double largest = 0, power = 0, speed2 = 0, force2 = 0;
#pragma omp simd reduction(max : largest) reduction(+ : power, speed2, force2)
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    largest = std::max(largest, std::abs(force[i]));
    power += force[i] * velocity[i];
    speed2 += velocity[i] * velocity[i];
    force2 += force[i] * force[i];
  }
  return {largest, power, speed2, force2};
}

void move_points(std::ptrdiff_t n, const PointMove& move, const double* __restrict force,
                 double* __restrict velocity, double* __restrict position) {
  const double kept = move.kept, gain = move.gain, fastest = move.fastest, time = move.time;
#pragma omp simd
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const double v = kept * velocity[i] + gain * force[i];
    const double not_too_slow = v > -fastest ? v : -fastest;
    velocity[i] = not_too_slow < fastest ? not_too_slow : fastest;
    position[i] += time * velocity[i];
  }
}

}  // namespace clog::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clog::kernel {

HWY_EXPORT(sum_forces);
ForceSums sum_forces(std::ptrdiff_t n, const double* force, const double* velocity) {
  return HWY_DYNAMIC_DISPATCH(sum_forces)(n, force, velocity);
}

HWY_EXPORT(move_points);
void move_points(std::ptrdiff_t n, const PointMove& move, const double* force, double* velocity,
                 double* position) {
  HWY_DYNAMIC_DISPATCH(move_points)(n, move, force, velocity, position);
}

}  // namespace clog::kernel
#endif

#include "dp_kernel.hpp"

#include <algorithm>
#include <cmath>

// GCC compiles the function once per listed instruction set and picks one at load time. The sanitizers cannot
// follow that indirection, and other compilers spell it differently: there, one version is enough.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define CLOG_MULTIVERSION __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define CLOG_MULTIVERSION
#endif

namespace clog::kernel {

CLOG_MULTIVERSION
Sums measure_edges(int n, const double* __restrict x, const double* __restrict y, EdgeArrays edges) {
  double* __restrict ex = edges.x;
  double* __restrict ey = edges.y;
  double* __restrict length = edges.length;
  for (int i = 0; i < n - 1; ++i) {
    ex[i] = x[i + 1] - x[i];
    ey[i] = y[i + 1] - y[i];
  }
  ex[n - 1] = x[0] - x[n - 1];
  ey[n - 1] = y[0] - y[n - 1];
  double perimeter = 0;
  double twice_area = 0;
#pragma omp simd reduction(+ : perimeter, twice_area)
  for (int i = 0; i < n; ++i) {
    const double l = std::sqrt(ex[i] * ex[i] + ey[i] * ey[i]);
    length[i] = l;
    perimeter += l;
    twice_area += x[i] * ey[i] - y[i] * ex[i];
  }
  return {0.5 * twice_area, perimeter};
}

CLOG_MULTIVERSION
void interface_forces(int n, const Interface& interface, EdgeArrays edges, double* __restrict pull,
                      double* __restrict fx, double* __restrict fy) {
  const double* __restrict ex = edges.x;
  const double* __restrict ey = edges.y;
  const double* __restrict length = edges.length;
  const double tension = interface.line_tension - interface.spring * interface.spring_length;
  const double spring = interface.spring;
  const double half_pressure = 0.5 * interface.pressure;
  const double weight = interface.vertex_weight;
  // Force along an edge over its length: (gamma + k_l N_v (l - l_ref))/l.
  for (int i = 0; i < n; ++i) pull[i] = tension / length[i] + spring;
  // The area's gradient at vertex i is half the chord between its neighbours, turned outwards.
  const auto vertex = [&](int i, int before) {
    fx[i] = pull[i] * ex[i] - pull[before] * ex[before] + half_pressure * (ey[i] + ey[before]) + weight;
    fy[i] = pull[i] * ey[i] - pull[before] * ey[before] - half_pressure * (ex[i] + ex[before]);
  };
  vertex(0, n - 1);
#pragma omp simd
  for (int i = 1; i < n; ++i) vertex(i, i - 1);
}

CLOG_MULTIVERSION
void add_wall_forces(int n, const double* __restrict x, const double* __restrict y, EdgeArrays edges,
                     WallSlot slot, double range, double stiffness, double* __restrict end_x,
                     double* __restrict end_y, double* __restrict fx, double* __restrict fy) {
  const double* __restrict ex = edges.x;
  const double* __restrict ey = edges.y;
  const double* __restrict length = edges.length;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const double to_x = slot.x[i] - x[i];
    const double to_y = slot.y[i] - y[i];
    const double along = (to_x * ex[i] + to_y * ey[i]) / (length[i] * length[i]);
    const double not_before =
        along > 0 ? along : 0.0;  // std::clamp would keep the loop from being vectorised
    const double fraction = not_before < 1 ? not_before : 1.0;
    const double dx = fraction * ex[i] - to_x;
    const double dy = fraction * ey[i] - to_y;
    const double r =
        std::sqrt(dx * dx + dy * dy) + 1e-300;  // a point on the very centre gets no direction, but no NaN
    const double overlap = std::max(0.0, range + slot.radius[i] - r);
    const double push = stiffness * overlap / r;
    end_x[i] = fraction * push * dx;
    end_y[i] = fraction * push * dy;
    fx[i] += (1 - fraction) * push * dx;
    fy[i] += (1 - fraction) * push * dy;
  }
  fx[0] += end_x[n - 1];
  fy[0] += end_y[n - 1];
#pragma omp simd
  for (int i = 1; i < n; ++i) {
    fx[i] += end_x[i - 1];
    fy[i] += end_y[i - 1];
  }
}

CLOG_MULTIVERSION
void shrink_to_wall_distance(int n, const double* __restrict x, const double* __restrict y, WallSlot slot,
                             double* __restrict distance) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const double dx = x[i] - slot.x[i];
    const double dy = y[i] - slot.y[i];
    distance[i] = std::min(distance[i], std::sqrt(dx * dx + dy * dy) - slot.radius[i]);
  }
}

CLOG_MULTIVERSION
void kick_and_drift(int n, double damping, double half_dt_over_m, double dt, const double* __restrict f,
                    double* __restrict v, double* __restrict x) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    v[i] = v[i] * (1 - damping) + f[i] * half_dt_over_m;
    x[i] += dt * v[i];
  }
}

CLOG_MULTIVERSION
void kick(int n, double damping, double half_dt_over_m, const double* __restrict f, double* __restrict v) {
  const double shrink = 1 / (1 + damping);
#pragma omp simd
  for (int i = 0; i < n; ++i) v[i] = (v[i] + f[i] * half_dt_over_m) * shrink;
}

CLOG_MULTIVERSION
void kick_and_drift(int n, const double* __restrict rate, double half_dt_over_m, double dt,
                    const double* __restrict f, double* __restrict v, double* __restrict x) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    v[i] = v[i] * (1 - 0.5 * dt * rate[i]) + f[i] * half_dt_over_m;
    x[i] += dt * v[i];
  }
}

CLOG_MULTIVERSION
void kick(int n, const double* __restrict rate, double half_dt_over_m, double dt, const double* __restrict f,
          double* __restrict v) {
#pragma omp simd
  for (int i = 0; i < n; ++i) v[i] = (v[i] + f[i] * half_dt_over_m) / (1 + 0.5 * dt * rate[i]);
}

}  // namespace clog::kernel

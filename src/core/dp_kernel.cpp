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
  double moment_x = 0;
  double moment_y = 0;
#pragma omp simd reduction(+ : perimeter, twice_area, moment_x, moment_y)
  for (int i = 0; i < n; ++i) {
    const double l = std::sqrt(ex[i] * ex[i] + ey[i] * ey[i]);
    const double cross = x[i] * ey[i] - y[i] * ex[i];
    length[i] = l;
    perimeter += l;
    twice_area += cross;
    moment_x += cross * (2 * x[i] + ex[i]);
    moment_y += cross * (2 * y[i] + ey[i]);
  }
  return {twice_area / 2, perimeter, moment_x / 6, moment_y / 6};
}

CLOG_MULTIVERSION
void interface_forces(int n, const double* __restrict x, const double* __restrict y,
                      const Interface& interface, EdgeArrays edges, double* __restrict pull,
                      double* __restrict fx, double* __restrict fy) {
  const double* __restrict ex = edges.x;
  const double* __restrict ey = edges.y;
  const double* __restrict length = edges.length;
  const double tension = interface.line_tension - interface.spring * interface.spring_length;
  const double spring = interface.spring;
  const double p = interface.pressure / 6;
  const double px = interface.pressure_x / 6;
  const double py = interface.pressure_y / 6;
  // Force along an edge over its length: (gamma + k_l N_v (l - l_ref))/l.
  for (int i = 0; i < n; ++i) pull[i] = tension / length[i] + spring;
  // An edge's pressure changes linearly along it; each vertex takes the part that its shape function weighs:
  // (2 p_i + p_j)/6 of the edge's outward normal, j the other end.
  const auto vertex = [&](int i, int before, int after) {
    const double here = p + px * x[i] + py * y[i];
    const double push_before = 2 * here + p + px * x[before] + py * y[before];
    const double push_after = 2 * here + p + px * x[after] + py * y[after];
    const double spread = interface.spreading * (length[i] - length[before]) / (length[i] + length[before]);
    fx[i] = spread * (ex[i] + ex[before]) + pull[i] * ex[i] - pull[before] * ex[before] + push_after * ey[i] +
            push_before * ey[before] + interface.vertex_x;
    fy[i] = spread * (ey[i] + ey[before]) + pull[i] * ey[i] - pull[before] * ey[before] - push_after * ex[i] -
            push_before * ex[before] + interface.vertex_y;
  };
  vertex(0, n - 1, 1);
#pragma omp simd
  for (int i = 1; i < n - 1; ++i) vertex(i, i - 1, i + 1);
  vertex(n - 1, n - 2, 0);
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
void add_vertex_wall_forces(int n, const double* __restrict x, const double* __restrict y, WallSlot slot,
                            double range, double stiffness, double* __restrict fx, double* __restrict fy) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const double dx = x[i] - slot.x[i];
    const double dy = y[i] - slot.y[i];
    const double r = std::sqrt(dx * dx + dy * dy) + 1e-300;
    const double push = stiffness * std::max(0.0, range + slot.radius[i] - r) / r;
    fx[i] += push * dx;
    fy[i] += push * dy;
  }
}

namespace {

/// Distance of a point to a wedge's surface and the direction away from it, as distance_to() in wedge.hpp.
struct AwayFromWedge {
  double distance, x, y;
};
inline AwayFromWedge away_from(const WedgePlace& wedge, double x, double y) {
  const double dx = x - wedge.x;
  const double dy = y - wedge.y;
  const double along = dx * wedge.axis_x + dy * wedge.axis_y;
  const double across = dy * wedge.axis_x - dx * wedge.axis_y;
  const double side = across < 0 ? -1.0 : 1.0;
  const double r = std::sqrt(dx * dx + dy * dy) + 1e-300;
  const bool before_tip = along * wedge.cos + std::abs(across) * wedge.sin < 0;
  const double to_flank = std::abs(across) * wedge.cos - along * wedge.sin;
  const double flank_x = -side * wedge.cos * wedge.axis_y - wedge.sin * wedge.axis_x;
  const double flank_y = side * wedge.cos * wedge.axis_x - wedge.sin * wedge.axis_y;
  return {(before_tip ? r : to_flank) - wedge.radius, before_tip ? dx / r : flank_x,
          before_tip ? dy / r : flank_y};
}

}  // namespace

CLOG_MULTIVERSION
void add_wedge_forces(int n, const double* __restrict x, const double* __restrict y, const WedgePlace& wedge,
                      double range, double stiffness, double* __restrict fx, double* __restrict fy) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const AwayFromWedge away = away_from(wedge, x[i], y[i]);
    const double push = stiffness * std::max(0.0, range - away.distance);
    fx[i] += push * away.x;
    fy[i] += push * away.y;
  }
}

CLOG_MULTIVERSION
void shrink_to_wedge_distance(int n, const double* __restrict x, const double* __restrict y,
                              const WedgePlace& wedge, double* __restrict distance) {
#pragma omp simd
  for (int i = 0; i < n; ++i) distance[i] = std::min(distance[i], away_from(wedge, x[i], y[i]).distance);
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
void kick_and_drift(int n, OwnDrag drag, double half_dt_over_m, double dt, const double* __restrict f,
                    double* __restrict v, double* __restrict x) {
  const double* __restrict rate = drag.rate;
  double mean = 0;
#pragma omp simd reduction(+ : mean)
  for (int i = 0; i < n; ++i) mean += v[i] / n;
  const double from_mean = 0.5 * dt * drag.relative_rate * mean;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    v[i] = v[i] * (1 - 0.5 * dt * rate[i]) + from_mean + f[i] * half_dt_over_m;
    x[i] += dt * v[i];
  }
}

// With r_i and e the rates times dt/2: v_i (1 + r_i) - e V = w_i and V = mean v. So v_i = (w_i + e V)/(1 +
// r_i), whose mean gives V.
CLOG_MULTIVERSION
void kick(int n, OwnDrag drag, double half_dt_over_m, double dt, const double* __restrict f,
          double* __restrict v) {
  const double* __restrict rate = drag.rate;
  const double relative = 0.5 * dt * drag.relative_rate;
  double mean = 0;
  double share = 0;
#pragma omp simd reduction(+ : mean, share)
  for (int i = 0; i < n; ++i) {
    const double shrink = 1 / (1 + 0.5 * dt * rate[i]);
    v[i] = (v[i] + f[i] * half_dt_over_m) * shrink;
    mean += v[i] / n;
    share += shrink / n;
  }
  const double from_mean = relative * mean / (1 - relative * share);
#pragma omp simd
  for (int i = 0; i < n; ++i) v[i] += from_mean / (1 + 0.5 * dt * rate[i]);
}

}  // namespace clog::kernel

#include "dp_kernel.hpp"

#include <algorithm>
#include <cmath>

#include "core/tools/vector_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/polygon/dp_kernel.cpp"
#include <hwy/foreach_target.h>
// The loops are plain; Highway compiles them for each of its targets.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace clog::kernel::HWY_NAMESPACE {

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

// d(a X) = surface integral of (x - X) times the outward displacement: each edge's (x - X) changes linearly
// along it, and a vertex takes the part that its shape function weighs, (2 q_i + q_j)/6 of the edge's outward
// normal.
void measure_centroid_gradient(int n, const double* __restrict x, const double* __restrict y,
                               EdgeArrays edges, const Sums& sums, CentroidGradient gradient) {
  const double* __restrict ex = edges.x;
  const double* __restrict ey = edges.y;
  double* __restrict xx = gradient.xx;
  double* __restrict xy = gradient.xy;
  double* __restrict yx = gradient.yx;
  double* __restrict yy = gradient.yy;
  const double centre_x = sums.moment_x / sums.area;
  const double centre_y = sums.moment_y / sums.area;
  const double scale = 1 / (6 * sums.area);
  const auto vertex = [&](int i, int before, int after) {
    const double x_before = scale * (2 * x[i] + x[before] - 3 * centre_x);
    const double x_after = scale * (2 * x[i] + x[after] - 3 * centre_x);
    const double y_before = scale * (2 * y[i] + y[before] - 3 * centre_y);
    const double y_after = scale * (2 * y[i] + y[after] - 3 * centre_y);
    xx[i] = x_after * ey[i] + x_before * ey[before];
    xy[i] = -x_after * ex[i] - x_before * ex[before];
    yx[i] = y_after * ey[i] + y_before * ey[before];
    yy[i] = -y_after * ex[i] - y_before * ex[before];
  };
  vertex(0, n - 1, 1);
#pragma omp simd
  for (int i = 1; i < n - 1; ++i) vertex(i, i - 1, i + 1);
  vertex(n - 1, n - 2, 0);
}

void add_body_force(int n, double force_x, double force_y, CentroidGradient gradient, double* __restrict fx,
                    double* __restrict fy) {
  const double* __restrict xx = gradient.xx;
  const double* __restrict xy = gradient.xy;
  const double* __restrict yx = gradient.yx;
  const double* __restrict yy = gradient.yy;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    fx[i] += force_x * xx[i] + force_y * yx[i];
    fy[i] += force_x * xy[i] + force_y * yy[i];
  }
}

void interface_forces(int n, const Interface& interface, EdgeArrays edges, double* __restrict pull,
                      double* __restrict fx, double* __restrict fy) {
  const double* __restrict ex = edges.x;
  const double* __restrict ey = edges.y;
  const double* __restrict length = edges.length;
  const double tension = interface.line_tension - interface.spring * interface.spring_length;
  const double spring = interface.spring;
  const double spreading = interface.spreading;
  const double half_pressure = 0.5 * interface.pressure;
  const double weight = interface.vertex_weight;
  // Force along an edge over its length: (gamma + k_l N_v (l - l_ref))/l.
  for (int i = 0; i < n; ++i) pull[i] = tension / length[i] + spring;
  // The area's gradient at vertex i is half the chord between its neighbours, turned outwards. Spreading
  // pulls along that chord, so it does no work on the area.
  const auto vertex = [&](int i, int before) {
    // spreading cos^2 (l - l')/(l + l'), cos the cosine between both edges, with a single division.
    const double dot = std::max(0.0, ex[i] * ex[before] + ey[i] * ey[before]);
    const double product = length[i] * length[before];
    const double spread = spreading * dot * dot * (length[i] - length[before]) /
                          (product * product * (length[i] + length[before]));
    const double chord_x = ex[i] + ex[before];
    const double chord_y = ey[i] + ey[before];
    fx[i] = pull[i] * ex[i] - pull[before] * ex[before] + half_pressure * chord_y + spread * chord_x + weight;
    fy[i] = pull[i] * ey[i] - pull[before] * ey[before] - half_pressure * chord_x + spread * chord_y;
  };
  vertex(0, n - 1);
#pragma omp simd
  for (int i = 1; i < n; ++i) vertex(i, i - 1);
}

void refine_edges(int n, const double* __restrict x, const double* __restrict y, RefinedEdges edges) {
  double* __restrict middle_x = edges.middle_x;
  double* __restrict middle_y = edges.middle_y;
  const auto edge = [&](int i, int before, int next, int after) {
    middle_x[i] = refined_near * (x[i] + x[next]) + refined_far * (x[before] + x[after]);
    middle_y[i] = refined_near * (y[i] + y[next]) + refined_far * (y[before] + y[after]);
  };
  edge(0, n - 1, 1, 2);
#pragma omp simd
  for (int i = 1; i < n - 2; ++i) edge(i, i - 1, i + 1, i + 2);
  edge(n - 2, n - 3, n - 1, 0);
  edge(n - 1, n - 2, 0, 1);
  std::fill_n(edges.begin_push_x, n, 0.0);
  std::fill_n(edges.begin_push_y, n, 0.0);
  std::fill_n(edges.middle_push_x, n, 0.0);
  std::fill_n(edges.middle_push_y, n, 0.0);
  std::fill_n(edges.end_push_x, n, 0.0);
  std::fill_n(edges.end_push_y, n, 0.0);
}

namespace {

/// Push on half an edge by a circle; `fraction` of it is the end's.
struct HalfPush {
  double x, y, fraction;
};
inline HalfPush push_half(double begin_x, double begin_y, double end_x, double end_y, double circle_x,
                          double circle_y, double reach, double stiffness) {
  const double ex = end_x - begin_x;
  const double ey = end_y - begin_y;
  const double to_x = circle_x - begin_x;
  const double to_y = circle_y - begin_y;
  const double along = (to_x * ex + to_y * ey) / std::max(ex * ex + ey * ey, 1e-200);
  const double not_before = along > 0 ? along : 0.0;  // std::clamp would keep loops from being vectorised
  const double fraction = not_before < 1 ? not_before : 1.0;
  const double dx = fraction * ex - to_x;
  const double dy = fraction * ey - to_y;
  const double r = std::sqrt(dx * dx + dy * dy) + 1e-300;  // a point on the very centre gets no NaN
  const double push = stiffness * std::max(0.0, reach - r) / r;
  return {push * dx, push * dy, fraction};
}

}  // namespace

void push_off_circle(int n, const double* __restrict x, const double* __restrict y, RefinedEdges edges,
                     const CircleAtEdges& circle, double stiffness) {
  const double* __restrict middle_x = edges.middle_x;
  const double* __restrict middle_y = edges.middle_y;
  double* __restrict begin_push_x = edges.begin_push_x;
  double* __restrict begin_push_y = edges.begin_push_y;
  double* __restrict middle_push_x = edges.middle_push_x;
  double* __restrict middle_push_y = edges.middle_push_y;
  double* __restrict end_push_x = edges.end_push_x;
  double* __restrict end_push_y = edges.end_push_y;
  const double circle_x = circle.x, circle_y = circle.y, reach = circle.reach;
  const auto edge = [&](int i, int next) {
    const HalfPush first =
        push_half(x[i], y[i], middle_x[i], middle_y[i], circle_x, circle_y, reach, stiffness);
    const HalfPush second =
        push_half(middle_x[i], middle_y[i], x[next], y[next], circle_x, circle_y, reach, stiffness);
    begin_push_x[i] += (1 - first.fraction) * first.x;
    begin_push_y[i] += (1 - first.fraction) * first.y;
    middle_push_x[i] += first.fraction * first.x + (1 - second.fraction) * second.x;
    middle_push_y[i] += first.fraction * first.y + (1 - second.fraction) * second.y;
    end_push_x[i] += second.fraction * second.x;
    end_push_y[i] += second.fraction * second.y;
  };
  const int end = std::min(circle.end, n - 1);
#pragma omp simd
  for (int i = circle.first; i < end; ++i) edge(i, i + 1);
  if (circle.end >= n) edge(n - 1, 0);
}

void hand_out_pushes(int n, RefinedEdges edges, double* __restrict fx, double* __restrict fy) {
  const double* __restrict begin_x = edges.begin_push_x;
  const double* __restrict begin_y = edges.begin_push_y;
  const double* __restrict middle_x = edges.middle_push_x;
  const double* __restrict middle_y = edges.middle_push_y;
  const double* __restrict end_x = edges.end_push_x;
  const double* __restrict end_y = edges.end_push_y;
  const auto vertex = [&](int i, int second_before, int before, int next) {
    fx[i] += begin_x[i] + end_x[before] + refined_near * (middle_x[i] + middle_x[before]) +
             refined_far * (middle_x[next] + middle_x[second_before]);
    fy[i] += begin_y[i] + end_y[before] + refined_near * (middle_y[i] + middle_y[before]) +
             refined_far * (middle_y[next] + middle_y[second_before]);
  };
  vertex(0, n - 2, n - 1, 1);
  vertex(1, n - 1, 0, 2);
#pragma omp simd
  for (int i = 2; i < n - 1; ++i) vertex(i, i - 2, i - 1, i + 1);
  vertex(n - 1, n - 3, n - 2, 0);
}

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

void shrink_to_wedge_distance(int n, const double* __restrict x, const double* __restrict y,
                              const WedgePlace& wedge, double* __restrict distance) {
#pragma omp simd
  for (int i = 0; i < n; ++i) distance[i] = std::min(distance[i], away_from(wedge, x[i], y[i]).distance);
}

void shrink_to_wall_distance(int n, const double* __restrict x, const double* __restrict y, WallSlot slot,
                             double* __restrict distance) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const double dx = x[i] - slot.x[i];
    const double dy = y[i] - slot.y[i];
    distance[i] = std::min(distance[i], std::sqrt(dx * dx + dy * dy) - slot.radius[i]);
  }
}

}  // namespace clog::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clog::kernel {

HWY_EXPORT(measure_edges);
Sums measure_edges(int n, const double* x, const double* y, EdgeArrays edges) {
  return HWY_DYNAMIC_DISPATCH(measure_edges)(n, x, y, edges);
}

HWY_EXPORT(measure_centroid_gradient);
void measure_centroid_gradient(int n, const double* x, const double* y, EdgeArrays edges, const Sums& sums,
                               CentroidGradient gradient) {
  HWY_DYNAMIC_DISPATCH(measure_centroid_gradient)(n, x, y, edges, sums, gradient);
}

HWY_EXPORT(add_body_force);
void add_body_force(int n, double force_x, double force_y, CentroidGradient gradient, double* fx,
                    double* fy) {
  HWY_DYNAMIC_DISPATCH(add_body_force)(n, force_x, force_y, gradient, fx, fy);
}

HWY_EXPORT(interface_forces);
void interface_forces(int n, const Interface& interface, EdgeArrays edges, double* pull, double* fx,
                      double* fy) {
  HWY_DYNAMIC_DISPATCH(interface_forces)(n, interface, edges, pull, fx, fy);
}

HWY_EXPORT(refine_edges);
void refine_edges(int n, const double* x, const double* y, RefinedEdges edges) {
  HWY_DYNAMIC_DISPATCH(refine_edges)(n, x, y, edges);
}

HWY_EXPORT(push_off_circle);
void push_off_circle(int n, const double* x, const double* y, RefinedEdges edges, const CircleAtEdges& circle,
                     double stiffness) {
  HWY_DYNAMIC_DISPATCH(push_off_circle)(n, x, y, edges, circle, stiffness);
}

HWY_EXPORT(hand_out_pushes);
void hand_out_pushes(int n, RefinedEdges edges, double* fx, double* fy) {
  HWY_DYNAMIC_DISPATCH(hand_out_pushes)(n, edges, fx, fy);
}

HWY_EXPORT(add_vertex_wall_forces);
void add_vertex_wall_forces(int n, const double* x, const double* y, WallSlot slot, double range,
                            double stiffness, double* fx, double* fy) {
  HWY_DYNAMIC_DISPATCH(add_vertex_wall_forces)(n, x, y, slot, range, stiffness, fx, fy);
}

HWY_EXPORT(add_wedge_forces);
void add_wedge_forces(int n, const double* x, const double* y, const WedgePlace& wedge, double range,
                      double stiffness, double* fx, double* fy) {
  HWY_DYNAMIC_DISPATCH(add_wedge_forces)(n, x, y, wedge, range, stiffness, fx, fy);
}

HWY_EXPORT(shrink_to_wedge_distance);
void shrink_to_wedge_distance(int n, const double* x, const double* y, const WedgePlace& wedge,
                              double* distance) {
  HWY_DYNAMIC_DISPATCH(shrink_to_wedge_distance)(n, x, y, wedge, distance);
}

HWY_EXPORT(shrink_to_wall_distance);
void shrink_to_wall_distance(int n, const double* x, const double* y, WallSlot slot, double* distance) {
  HWY_DYNAMIC_DISPATCH(shrink_to_wall_distance)(n, x, y, slot, distance);
}

}  // namespace clog::kernel
#endif

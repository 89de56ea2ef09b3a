#include "clog/core/droplet/shape.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "clog/core/tools/portable_math.hpp"

namespace clog {
namespace {

/// Twice the signed area of a triangle, positive for counter-clockwise.
double twice_area(const Eigen::Array2d& a, const Eigen::Array2d& b, const Eigen::Array2d& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Whether a and b are strictly on different sides of the line through c and d.
bool separates(const Eigen::Array2d& c, const Eigen::Array2d& d, const Eigen::Array2d& a,
               const Eigen::Array2d& b) {
  const double side_a = twice_area(c, d, a);
  const double side_b = twice_area(c, d, b);
  return (side_a > 0 && side_b < 0) || (side_a < 0 && side_b > 0);
}

}  // namespace

double PolygonShape::shape_parameter() const { return perimeter * perimeter / (4 * std::numbers::pi * area); }

PolygonShape polygon_shape(const Eigen::ArrayXd& position) {
  const Eigen::Index n = position.size() / 2;
  const double* x = position.data();
  const double* y = x + n;
  double perimeter = 0, area = 0;
  const auto add_edge = [&](Eigen::Index i, Eigen::Index j) {
    const double ex = x[i] - x[j];
    const double ey = y[i] - y[j];
    perimeter += std::sqrt(ex * ex + ey * ey);
    area += 0.5 * (x[j] * ey - y[j] * ex);
  };
  add_edge(0, n - 1);
#pragma omp simd reduction(+ : perimeter, area)
  for (Eigen::Index i = 1; i < n; ++i) add_edge(i, i - 1);
  return {.area = area, .perimeter = perimeter};
}

Eigen::ArrayXd regular_polygon(int num_vertices, double area) {
  const double angle = 2 * std::numbers::pi / num_vertices;
  const double circumradius = std::sqrt(2 * area / (num_vertices * portable::sin(angle)));
  Eigen::ArrayXd position(2 * num_vertices);
  for (int i = 0; i < num_vertices; ++i) {
    position[i] = circumradius * portable::cos(i * angle);
    position[num_vertices + i] = circumradius * portable::sin(i * angle);
  }
  return position;
}

Eigen::ArrayXd refined(const Eigen::ArrayXd& position) {
  const Eigen::Index n = position.size() / 2;
  Eigen::ArrayXd fine(4 * n);
  for (const Eigen::Index axis : {0, 1}) {
    const auto coarse = position.segment(axis * n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      fine[2 * (axis * n + i)] = coarse[i];
      fine[2 * (axis * n + i) + 1] = refined_near * (coarse[i] + coarse[(i + 1) % n]) +
                                     refined_far * (coarse[(i + n - 1) % n] + coarse[(i + 2) % n]);
    }
  }
  return fine;
}

bool encloses(const Eigen::ArrayXd& position, double x, double y) {
  const Eigen::Index n = position.size() / 2;
  const auto px = position.head(n);
  const auto py = position.tail(n);
  bool inside = false;
  for (Eigen::Index i = 0, j = n - 1; i < n; j = i++) {
    if ((py[i] > y) != (py[j] > y) && x < (px[j] - px[i]) * (y - py[i]) / (py[j] - py[i]) + px[i])
      inside = !inside;
  }
  return inside;
}

int num_self_crossings(const Eigen::ArrayXd& position) {
  const int n = static_cast<int>(position.size() / 2);
  const auto x = position.head(n);
  const auto y = position.tail(n);
  // Edges are sorted by their lower ends along the longer side of the contour's bounding box. Along this
  // side, few edges overlap.
  const bool is_wide = x.maxCoeff() - x.minCoeff() > y.maxCoeff() - y.minCoeff();
  const double* along = is_wide ? position.data() : position.data() + n;
  const double* across = is_wide ? position.data() + n : position.data();
  const auto end = [n](int edge) { return edge + 1 < n ? edge + 1 : 0; };
  const auto low = [&](const double* u, int edge) { return std::min(u[edge], u[end(edge)]); };
  const auto high = [&](const double* u, int edge) { return std::max(u[edge], u[end(edge)]); };
  std::vector<int> edges(n);
  std::iota(edges.begin(), edges.end(), 0);
  std::sort(edges.begin(), edges.end(), [&](int e, int f) { return low(along, e) < low(along, f); });

  const auto cross = [&](int e, int f) {
    if (end(e) == f || end(f) == e) return false;
    if (low(across, e) > high(across, f) || low(across, f) > high(across, e)) return false;
    const Eigen::Array2d a{x[e], y[e]}, b{x[end(e)], y[end(e)]}, c{x[f], y[f]}, d{x[end(f)], y[end(f)]};
    return separates(c, d, a, b) && separates(a, b, c, d);
  };
  int crossings = 0;
  for (auto e = edges.begin(); e != edges.end(); ++e)
    for (auto f = e + 1; f != edges.end() && low(along, *f) <= high(along, *e); ++f)
      crossings += cross(*e, *f);
  return crossings;
}

Eigen::Array2d nearest_on_segment(const Eigen::Array2d& point, const Eigen::Array2d& begin,
                                  const Eigen::Array2d& end) {
  const Eigen::Array2d edge = end - begin;
  const double length2 = edge.square().sum();
  const double along = length2 > 0 ? std::clamp((edge * (point - begin)).sum() / length2, 0.0, 1.0) : 0.0;
  return begin + along * edge;
}

double distance_to_segment(const Eigen::Array2d& point, const Eigen::Array2d& begin,
                           const Eigen::Array2d& end) {
  return (point - nearest_on_segment(point, begin, end)).matrix().norm();
}

Eigen::Array2d area_centroid(const Eigen::ArrayXd& position) {
  const Eigen::Index n = position.size() / 2;
  const auto x = position.head(n);
  const auto y = position.tail(n);
  double twice_area = 0;
  Eigen::Array2d moment{0, 0};
  for (Eigen::Index i = 0, j = n - 1; i < n; j = i++) {
    const double cross = x[j] * y[i] - x[i] * y[j];
    twice_area += cross;
    moment += cross * Eigen::Array2d(x[j] + x[i], y[j] + y[i]);
  }
  return moment / (3 * twice_area);
}

// Applies the quotient rule to the sums of area_centroid().
Eigen::Array2d area_centroid_velocity(const Eigen::ArrayXd& position, const Eigen::ArrayXd& velocity) {
  const Eigen::Index n = position.size() / 2;
  const auto at = [n](const Eigen::ArrayXd& points, Eigen::Index i) {
    return Eigen::Array2d(points[i], points[n + i]);
  };
  const auto cross = [](const Eigen::Array2d& a, const Eigen::Array2d& b) {
    return a[0] * b[1] - a[1] * b[0];
  };
  assert(velocity.size() == position.size());
  const Eigen::Array2d centroid = area_centroid(position);
  double twice_area = 0;
  Eigen::Array2d change{0, 0};
  for (Eigen::Index i = 0, j = n - 1; i < n; j = i++) {
    const Eigen::Array2d a = at(position, j), b = at(position, i);
    const Eigen::Array2d va = at(velocity, j), vb = at(velocity, i);
    const double sector = cross(a, b);
    const double sector_rate = cross(va, b) + cross(a, vb);
    twice_area += sector;
    change += sector_rate * (a + b - 3 * centroid) + sector * (va + vb);
  }
  return change / (3 * twice_area);
}

}  // namespace clog

#include "clog/core/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clog {

double PolygonShape::shape_parameter() const { return perimeter * perimeter / (4 * std::numbers::pi * area); }

PolygonShape polygon_shape(const Eigen::ArrayXd& position) {
  const Eigen::Index n = position.size() / 2;
  const double* x = position.data();
  const double* y = x + n;
  PolygonShape shape;
  for (Eigen::Index i = 0, j = n - 1; i < n; j = i++) {
    const double ex = x[i] - x[j];
    const double ey = y[i] - y[j];
    shape.perimeter += std::sqrt(ex * ex + ey * ey);
    shape.area += 0.5 * (x[j] * ey - y[j] * ex);
  }
  return shape;
}

Eigen::ArrayXd regular_polygon(int num_vertices, double area) {
  const double angle = 2 * std::numbers::pi / num_vertices;
  const double circumradius = std::sqrt(2 * area / (num_vertices * std::sin(angle)));
  Eigen::ArrayXd position(2 * num_vertices);
  for (int i = 0; i < num_vertices; ++i) {
    position[i] = circumradius * std::cos(i * angle);
    position[num_vertices + i] = circumradius * std::sin(i * angle);
  }
  return position;
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

double distance_to_segment(const Eigen::Array2d& point, const Eigen::Array2d& begin,
                           const Eigen::Array2d& end) {
  const Eigen::Array2d edge = end - begin;
  const double length2 = edge.square().sum();
  const double along = length2 > 0 ? std::clamp((edge * (point - begin)).sum() / length2, 0.0, 1.0) : 0.0;
  return (point - begin - along * edge).matrix().norm();
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

}  // namespace clog

#include "clog/core/polygon/cut.hpp"

#include <cassert>
#include <cmath>
#include <vector>

#include "clog/core/droplet/shape.hpp"

namespace clog {
namespace {

using Eigen::Array2d;
using Eigen::Index;

Array2d point(const Eigen::ArrayXd& all, Index i) { return {all[i], all[all.size() / 2 + i]}; }

Array2d mean(const Eigen::ArrayXd& all) {
  return {all.head(all.size() / 2).mean(), all.tail(all.size() / 2).mean()};
}

void add(Eigen::ArrayXd& all, const Array2d& vector) {
  all.head(all.size() / 2) += vector[0];
  all.tail(all.size() / 2) += vector[1];
}

/// A vertex with its velocity.
struct Vertex {
  Array2d position, velocity;
};

Vertex vertex(const MovingPolygon& polygon, Index i) {
  return {point(polygon.position, i), point(polygon.velocity, i)};
}

/// A vertex between two vertices; `place` is 0 at the first vertex and 1 at the second.
Vertex between(const Vertex& first, const Vertex& second, double place) {
  return {first.position + place * (second.position - first.position),
          first.velocity + place * (second.velocity - first.velocity)};
}

MovingPolygon polygon_of(const std::vector<Vertex>& vertices) {
  const auto n = static_cast<Index>(vertices.size());
  MovingPolygon polygon{Eigen::ArrayXd(2 * n), Eigen::ArrayXd(2 * n)};
  for (Index i = 0; i < n; ++i)
    for (const int axis : {0, 1}) {
      polygon.position[axis * n + i] = vertices[i].position[axis];
      polygon.velocity[axis * n + i] = vertices[i].velocity[axis];
    }
  return polygon;
}

/// The part of the contour from vertex `first` to vertex `last`, including both. The vertex `end` is added
/// unless it is at one of these two vertices.
MovingPolygon part(const MovingPolygon& whole, Index first, Index last, const Vertex& end) {
  const Index n = whole.position.size() / 2;
  std::vector<Vertex> vertices;
  for (Index i = first; i != last; i = (i + 1) % n) vertices.push_back(vertex(whole, i));
  vertices.push_back(vertex(whole, last));
  const auto is_end = [&](const Vertex& one) { return (one.position == end.position).all(); };
  if (!is_end(vertices.front()) && !is_end(vertices.back())) vertices.push_back(end);
  return polygon_of(vertices);
}

}  // namespace

std::array<MovingPolygon, 2> cut(const MovingPolygon& whole, const Neck& neck) {
  const Index n = whole.position.size() / 2;
  const Index after = (neck.edge + 1) % n;
  const Vertex end = between(vertex(whole, neck.edge), vertex(whole, after), neck.place);
  std::array<MovingPolygon, 2> parts = {part(whole, neck.vertex, neck.edge, end),
                                        part(whole, after, neck.vertex, end)};
  Array2d momentum{0, 0};
  double area = 0;
  for (const MovingPolygon& one : parts) {
    const double share = polygon_shape(one.position).area;
    momentum += share * mean(one.velocity);
    area += share;
  }
  const Array2d missing = mean(whole.velocity) - momentum / area;
  for (MovingPolygon& one : parts) add(one.velocity, missing);
  return parts;
}

MovingPolygon with_vertices(const MovingPolygon& polygon, int num_vertices) {
  assert(num_vertices >= 3);
  const Index n = polygon.position.size() / 2;
  const PolygonShape shape = polygon_shape(polygon.position);
  std::vector<Vertex> vertices;
  double way = 0;  // distance along the contour to vertex i
  for (Index i = 0; i < n; ++i) {
    const Vertex from = vertex(polygon, i), to = vertex(polygon, (i + 1) % n);
    const double length = std::sqrt((to.position - from.position).square().sum());
    const auto next = [&] {
      return shape.perimeter * static_cast<double>(vertices.size()) / num_vertices - way;
    };
    while (static_cast<int>(vertices.size()) < num_vertices && next() < length)
      vertices.push_back(between(from, to, next() / length));
    way += length;
  }
  // Because of rounding, the last vertex may be beyond the end of the contour.
  while (static_cast<int>(vertices.size()) < num_vertices) vertices.push_back(vertex(polygon, 0));
  MovingPolygon spread = polygon_of(vertices);
  const Array2d centroid = area_centroid(polygon.position);
  add(spread.position, -area_centroid(spread.position));
  spread.position *= std::sqrt(shape.area / polygon_shape(spread.position).area);
  add(spread.position, centroid);
  add(spread.velocity, mean(polygon.velocity) - mean(spread.velocity));
  return spread;
}

}  // namespace clog

#include "findings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "clog/core/droplet/release.hpp"
#include "clog/core/droplet/shape.hpp"
#include "clog/core/tools/units.hpp"

namespace clog::soundness {
namespace {

/// The largest depth of an obstacle's surface inside the interface [sigma], or 0 if no obstacle reaches the
/// interface.
double deepest_wall(const DropletState& state, const ObstacleArray& obstacles) {
  const Eigen::ArrayXd interface = refined(state.position);
  const Eigen::Index n = interface.size() / 2;
  const auto x = interface.head(n), y = interface.tail(n);
  std::vector<Obstacle> near;
  obstacles.gather({state.frame.origin[0], state.frame.origin[1], x.minCoeff(), x.maxCoeff(), y.minCoeff(),
                    y.maxCoeff(), 0},
                   near);
  double deepest = 0;
  for (Eigen::Index i = 0, j = n - 1; i < n; j = i++)
    for (const Obstacle& obstacle : near)
      deepest = std::max(deepest, obstacle.radius - distance_to_segment({obstacle.x, obstacle.y},
                                                                        {x[j], y[j]}, {x[i], y[i]}));
  return deepest;
}

double edge_ratio(const DropletState& state) {
  const Eigen::Index n = state.size();
  double shortest = std::numeric_limits<double>::infinity();
  double longest = 0;
  for (Eigen::Index i = 0, j = n - 1; i < n; j = i++) {
    const double length = std::hypot(state.x()[i] - state.x()[j], state.y()[i] - state.y()[j]);
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  return longest / shortest;
}

}  // namespace

void Findings::keep_worst(const Findings& other) {
  crossings = std::max(crossings, other.crossings);
  enclosed = std::max(enclosed, other.enclosed);
  overlap = std::max(overlap, other.overlap);
  area_error = std::max(area_error, other.area_error);
  edge_ratio = std::max(edge_ratio, other.edge_ratio);
  perimeter = std::max(perimeter, other.perimeter);
  shape = std::max(shape, other.shape);
  substeps = std::max(substeps, other.substeps);
}

bool is_sound(const Findings& findings) {
  return findings.crossings == 0 && findings.enclosed == 0 && findings.overlap <= deepest_overlap &&
         findings.area_error <= largest_area_error;
}

Findings look_at(const DropletState& state, const ObstacleArray& obstacles) {
  const int usual = std::min(128, static_cast<int>(state.size()));
  const double vertex_diameter = units::regular_edge_length(usual);
  const PolygonShape shape = polygon_shape(state.position);
  Findings findings;
  findings.crossings = num_self_crossings(state.position);
  findings.enclosed = num_enclosed(state, obstacles);
  findings.overlap = deepest_wall(state, obstacles) / vertex_diameter;
  findings.area_error = std::abs(shape.area / units::rest_area - 1);
  findings.edge_ratio = edge_ratio(state);
  findings.perimeter = shape.perimeter / (std::numbers::pi * units::droplet_diameter);
  findings.shape = shape.shape_parameter();
  return findings;
}

}  // namespace clog::soundness

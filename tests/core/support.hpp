#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "clog/core/droplet/shape.hpp"
#include "clog/core/polygon/forces/dp_forces.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/units.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog::test {

/// Parameters with a number for every automatic value. resolve() does not check them, so that tests can
/// switch terms off.
inline RunParameters bare_parameters(int vertices = 64) {
  RunParameters run;
  run.dp.vertices = vertices;
  run.time_step = 1e-3;
  run.dp.area_stiffness = 1e4;
  run.dp.perimeter_stiffness = 1.0;
  // These springs have an energy, because tests compare forces with the gradient of the energy.
  run.dp.perimeter_spring = PerimeterSpring::mean;
  run.dp.gravity = Gravity::vertex;
  const double l0 = units::regular_edge_length(vertices);
  run.wall_stiffness = wall_stiffness(1000, l0);
  // These are the published ranges of contacts, so that tests cover them, too.
  run.dp.contact_range = l0 / 2;
  run.dp.self_contact_range = l0;
  run.obstacles.box = 20;
  return run;
}

/// Moves the run's droplet to a channel, and resolves the parameters.
inline RunParameters in_channel(RunParameters run, const ChannelParameters& channel) {
  run.obstacles = {};
  run.obstacles.layout = ObstacleLayout::channel;
  run.channel = channel;
  return resolve(run);
}
inline RunParameters onto_wall(RunParameters run) {
  run.obstacles = {};
  run.obstacles.layout = ObstacleLayout::wall;
  return resolve(run);
}

inline ObstacleArray no_obstacles(double box = 20) { return {box, {}}; }

inline DropletState state_of(const Eigen::ArrayXd& position, double box = 20) {
  DropletState state;
  state.position = position;
  state.velocity = Eigen::ArrayXd::Zero(position.size());
  state.frame.period = {box, box};
  return state;
}

/// The polygon after every coordinate was moved at random by up to `amount`.
inline Eigen::ArrayXd shaken(Eigen::ArrayXd position, double amount, unsigned seed = 1) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-amount, amount);
  for (double& value : position) value += uniform(engine);
  return position;
}

inline constexpr double no_drag = 1e200;  // with such a large terminal speed there is no drag

/// An ellipse with the droplet's area. Line tension makes it swing.
inline Eigen::ArrayXd ellipse(int n, double stretch) {
  Eigen::ArrayXd position = regular_polygon(n, units::rest_area);
  position.head(n) *= stretch;
  position.tail(n) /= stretch;
  return position;
}

/// Two lobes joined by a neck of the given width, counter-clockwise. The vertices are evenly spread along the
/// contour, so that no edge is much shorter than the others.
inline Eigen::ArrayXd dumbbell(int num_vertices, double neck) {
  const auto point = [neck](double t) {
    const double c = std::cos(t);
    return Eigen::Array2d(0.7 * c, std::sin(t) * (neck / 2 + 0.5 * c * c));
  };
  constexpr int fine = 20000;
  std::vector<double> length(fine + 1, 0);
  for (int i = 1; i <= fine; ++i)
    length[i] = length[i - 1] +
                (point(2 * std::numbers::pi * i / fine) - point(2 * std::numbers::pi * (i - 1) / fine))
                    .matrix()
                    .norm();
  Eigen::ArrayXd position(2 * num_vertices);
  for (int k = 0, i = 0; k < num_vertices; ++k) {
    while (length[i] < length[fine] * k / num_vertices) ++i;
    const Eigen::Array2d p = point(2 * std::numbers::pi * i / fine);
    position[k] = p[0];
    position[num_vertices + k] = p[1];
  }
  return position;
}

/// Numbers the vertices of a contour anew, beginning with vertex `first`.
inline Eigen::ArrayXd renumbered(const Eigen::ArrayXd& position, int first) {
  const Eigen::Index n = position.size() / 2;
  Eigen::ArrayXd result(position.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    result[i] = position[(i + first) % n];
    result[n + i] = position[n + (i + first) % n];
  }
  return result;
}

/// The number of vertices that walls hold through films. A vertex counts if its wall also holds another
/// vertex nearer to the wall's centre.
inline int num_behind_films(const DropletState& state) {
  return static_cast<int>(std::ranges::count_if(state.anchors, [&](const WallAnchor& one) {
    return std::ranges::any_of(state.anchors, [&](const WallAnchor& other) {
      return std::hypot(one.wall.x - other.wall.x, one.wall.y - other.wall.y) < 1e-6 &&
             other.wall.radius < one.wall.radius - 1e-6;
    });
  }));
}

}  // namespace clog::test

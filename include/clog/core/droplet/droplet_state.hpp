#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

#include "clog/core/droplet/wall_anchor.hpp"
#include "clog/core/tools/byte_archive.hpp"
#include "clog/core/tools/units.hpp"

namespace clog {

/// Position of a droplet's local coordinates in the periodic plane: global = image * period + origin + local.
/// The origin follows the droplet in steps of whole units, so local coordinates stay of order one at any
/// distance. The origin is always in the first period. Droplets that are one period apart therefore feel
/// equal forces, bit for bit.
struct LocalFrame {
  Eigen::Array2d period{0, 0};                   ///< lengths of the period along and across the flow [sigma]
  Eigen::Array2d origin{0, 0};                   ///< a place in the first period [sigma]
  Eigen::Array<std::int64_t, 2, 1> image{0, 0};  ///< whole periods

  Eigen::Array2d global(const Eigen::Array2d& local) const {
    return image.cast<double>() * period + origin + local;
  }
  /// Displacement from a place in another frame of the same period to a place in this frame. The computation
  /// avoids large global coordinates, because these would lose digits.
  Eigen::Array2d displacement(const Eigen::Array2d& local, const LocalFrame& from,
                              const Eigen::Array2d& from_local) const {
    return (image - from.image).cast<double>() * period + (origin - from.origin) + (local - from_local);
  }
  void save(ByteWriter& bytes) const {
    bytes.put(period);
    bytes.put(origin);
    bytes.put(image[0]);
    bytes.put(image[1]);
  }
  void restore(ByteReader& bytes) {
    bytes.get(period);
    bytes.get(origin);
    bytes.get(image[0]);
    bytes.get(image[1]);
  }
  /// Moves the origin by a whole-numbered step [sigma].
  void shift(const Eigen::Array2d& step) {
    origin += step;
    for (int axis = 0; axis < 2; ++axis) {
      while (origin[axis] >= period[axis]) origin[axis] -= period[axis], ++image[axis];
      while (origin[axis] < 0) origin[axis] += period[axis], --image[axis];
    }
  }
};

/// Bounds on how far any point may move until the next check [sigma].
struct Travel {
  double absolute = 0;
  double relative = 0;  ///< displacement relative to the mean of the points
};
/// Upper bound on the distance that a point with this initial speed covers in a time [t0]. The bound is at
/// least twice the distance of a free fall.
inline double possible_distance(double speed, double time) {
  return 2 * time * (speed + units::gravity * time);
}
/// Largest displacement that contact lists can allow for [sigma]. A droplet that moves farther between two
/// updates has diverged.
inline constexpr double widest_skin = 4;

/// A vertex that has passed through an edge of the same droplet, see SelfCrossings.
struct SelfCrossing {
  Eigen::Index vertex, edge;  ///< edge e joins vertices e and e + 1 (mod N)
};

/// Points (the polygon's vertices, or the soft disk's centre) and their velocities. Coordinates are one
/// array, all x then all y, so that integrator and minimiser use plain vectors.
struct DropletState {
  Eigen::ArrayXd position;  ///< 2N, local [sigma]
  Eigen::ArrayXd velocity;  ///< 2N [sqrt(sigma g)]
  LocalFrame frame;
  std::vector<WallAnchor> anchors;      ///< where walls hold the interface
  std::vector<SelfCrossing> crossings;  ///< usually none
  std::int64_t num_healed = 0;          ///< number of crossings that have ended

  Eigen::Index size() const { return position.size() / 2; }
  auto x() { return position.head(size()); }
  auto x() const { return position.head(size()); }
  auto y() { return position.tail(size()); }
  auto y() const { return position.tail(size()); }
  /// Mean of the points [sigma]; this is the centre of mass, because all points have equal masses.
  Eigen::Array2d centre() const { return {x().mean(), y().mean()}; }
  Eigen::Array2d mean_velocity() const {
    return {velocity.head(size()).mean(), velocity.tail(size()).mean()};
  }

  /// See possible_distance().
  Travel possible_travel(double time) const {
    const Eigen::Array2d drift = mean_velocity();
    const auto vx = velocity.head(size());
    const auto vy = velocity.tail(size());
    return {.absolute = possible_distance(std::sqrt((vx.square() + vy.square()).maxCoeff()), time),
            .relative = possible_distance(
                std::sqrt(((vx - drift[0]).square() + (vy - drift[1]).square()).maxCoeff()), time)};
  }

  void save(ByteWriter& bytes) const {
    bytes.put(position);
    bytes.put(velocity);
    frame.save(bytes);
    bytes.put(anchors);
    bytes.put(crossings);
    bytes.put(num_healed);
  }
  void restore(ByteReader& bytes) {
    bytes.get(position);
    bytes.get(velocity);
    frame.restore(bytes);
    bytes.get(anchors);
    bytes.get(crossings);
    bytes.get(num_healed);
  }

  /// Keeps local coordinates of order one: if the centre is more than one diameter from the origin along
  /// either axis, moves the frame by whole units. The frame of a diverged droplet does not move, because such
  /// a droplet may be infinitely far away. Returns the shift (usually zero).
  Eigen::Array2d recentre() {
    constexpr double diverged = 1e6;  // [sigma]
    const Eigen::Array2d centre_now = centre();
    if ((centre_now.abs() <= 1).all() || !(centre_now.abs() < diverged).all()) return {0, 0};
    Eigen::Array2d step = centre_now.round();
    x() -= step[0];
    y() -= step[1];
    for (WallAnchor& anchor : anchors) {
      anchor.wall.x -= step[0];
      anchor.wall.y -= step[1];
    }
    frame.shift(step);
    return step;
  }
};

}  // namespace clog

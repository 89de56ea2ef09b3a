#pragma once

#include <Eigen/Core>
#include <vector>

#include "clog/core/droplet_state.hpp"
#include "clog/core/obstacle_array.hpp"

namespace clog {

/// For every point of a droplet, the obstacles it may touch before the list has to be renewed.
///
/// A point lists every obstacle whose surface was within `range` + skin of it, or, with `nearest`, every
/// obstacle that could become the nearest. Lists hold while no point has moved by more than the skin.
/// They are kept as `slots`: slot s of point i is one circle; unused slots hold a circle out of reach, so
/// that the force loop has no branch.
class WallContacts {
 public:
  enum class Keep { touching, nearest };

  /// @param range  largest surface distance at which a wall force acts [sigma]
  WallContacts(const ObstacleArray& array, double range, Keep keep);

  /// Renews the lists when a point may have left its skin before `horizon` more time has passed [t0].
  void update(const DropletState& state, double horizon);
  /// Forgets the lists: positions changed by more than a move (a new frame origin, a rescaled polygon).
  void invalidate() { reference_.resize(0); }

  int num_slots() const { return num_slots_; }
  Eigen::Index num_points() const { return num_points_; }
  /// Centres and radii of slot `s`, one per point, relative to the state's frame [sigma].
  const double* slot_x(int s) const { return slots_.data() + (3 * s + 0) * num_points_; }
  const double* slot_y(int s) const { return slots_.data() + (3 * s + 1) * num_points_; }
  const double* slot_radius(int s) const { return slots_.data() + (3 * s + 2) * num_points_; }
  /// Obstacles around the droplet at the last renewal, relative to the frame.
  const std::vector<Obstacle>& nearby() const { return nearby_; }
  double range() const { return range_; }

 private:
  const ObstacleArray* array_;
  double range_;
  Keep keep_;
  double skin_;
  int num_slots_ = 0;
  Eigen::Index num_points_ = 0;
  Eigen::ArrayXd reference_;
  Eigen::ArrayXd slots_;
  std::vector<Obstacle> nearby_;
  std::vector<std::vector<int>> candidates_;

  void rebuild(const DropletState& state);
  void gather_nearby(const DropletState& state);
};

}  // namespace clog

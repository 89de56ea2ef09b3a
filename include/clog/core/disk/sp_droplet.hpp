#pragma once

#include <vector>

#include "clog/core/droplet/droplet.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// Potential energy of a soft disk among obstacles (Cheng et al. Eq. 8), and the force that derives from it.
/// Let d be the distance from the disk's centre to the surface of an obstacle or wedge (d < 0: the centre is
/// inside). If d < sigma/2, this obstacle or wedge contributes (E_w/2)(1 - 2d/sigma)^2. The force is finite
/// everywhere; exactly at an obstacle's centre it is zero.
class SpForces {
 public:
  SpForces(const RunParameters& run, const ObstacleArray& obstacles);

  void update_contacts(const DropletState& state, const Travel& travel);
  void forget_contacts() { listed_ = false; }
  /// Force on a disk at `place` [g rho sigma^2].
  Eigen::Array2d force_at(const Eigen::Array2d& place, const LocalFrame& frame) const;
  /// force_at() times `scale`, for the loop over steps.
  Eigen::Array2d scaled_force(double scale, const Eigen::Array2d& place, const LocalFrame& frame) const;
  /// force: (f_x, f_y)
  void evaluate(const DropletState& state, Eigen::ArrayXd& force) const;
  PotentialEnergy energy(const DropletState& state) const;
  void set_weight(double weight) { weight_[0] = weight; }

 private:
  const ObstacleArray* obstacles_;
  double wall_stiffness_;
  Eigen::Array2d weight_;
  bool listed_ = false;
  double skin_ = 0;  // distance that the disk may move before near_ must be rebuilt
  Eigen::Array2d reference_{0, 0};
  std::vector<Obstacle> near_;

  Eigen::Array2d wedge_force(const Eigen::Array2d& place, const LocalFrame& frame) const;
  /// Calls visit(distance, normal) for every wedge.
  template <class Visit>
  void visit_wedges(const Eigen::Array2d& place, const LocalFrame& frame, Visit visit) const;
};

/// Soft disk: one point of mass M with drag -b_inf v. The integrator is that of DpDroplet, but the loop
/// stores the displacement per step instead of the velocity. This shortens the longest chain of dependent
/// operations in a step to one root, one division and a few sums.
class SpDroplet final : public Droplet {
 public:
  SpDroplet(const RunParameters& run, const ObstacleArray& obstacles, DropletState initial);

  void advance(int num_steps) override;
  void rebuild_lists() override;
  double kinetic_energy() const override;
  PotentialEnergy potential_energy() const override { return forces_.energy(state_); }
  PolygonShape shape() const override;

 private:
  RunParameters run_;
  SpForces forces_;
  Eigen::Array2d force_;

  void integrate(int num_steps);
};

}  // namespace clog

#pragma once

#include "clog/core/dp_forces.hpp"
#include "clog/core/droplet.hpp"
#include "clog/core/stability.hpp"

namespace clog {

/// Deformable polygon, integrated by velocity Verlet with drag (Cheng et al., "Simulation Methods"):
///   v += dt/2 (F - zeta v)/m,  x += dt v,  v = (v + dt/2 F/m)/(1 + dt zeta/(2m)),
/// the drag of the second half kick being implicit, so that strong near-wall drag cannot destabilise it.
/// The time step is split when the droplet's present perimeter makes a mode too stiff for it.
class DpDroplet final : public Droplet {
 public:
  /// @param run        resolved parameters
  /// @param obstacles  must outlive the droplet
  /// @param initial    vertices and velocities
  DpDroplet(const RunParameters& run, const ObstacleArray& obstacles, DropletState initial);

  void advance(int num_steps) override;
  double kinetic_energy() const override;
  PolygonShape shape() const override { return polygon_shape(state_.position); }
  DpEnergy potential_energy() const { return forces_.energy(state_); }
  const DpForces& forces() const { return forces_; }
  /// See DpForces::deepest_overlap().
  double deepest_overlap() const { return forces_.deepest_overlap(state_); }

 private:
  RunParameters run_;
  DpForces forces_;
  double vertex_mass_;
  Eigen::ArrayXd force_;
  Eigen::ArrayXd drag_rate_;  // with near-wall drag: zeta/m of the vertices [1/t0], for x and again for y

  void step(double time_step);
  void measure_drag();
};

}  // namespace clog

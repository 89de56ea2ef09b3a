#pragma once

#include <memory>

#include "clog/core/droplet/droplet.hpp"
#include "clog/core/polygon/forces/dp_forces.hpp"

namespace clog {
class DpStepper;

/// Deformable polygon, integrated by velocity Verlet with drag (Cheng et al., "Simulation Methods"):
///   v += dt/2 (F - zeta v)/m,  x += dt v,  v = (v + dt/2 F/m)/(1 + dt zeta/(2m)).
/// The drag of the second half kick is implicit, so that strong near-wall drag cannot destabilise the motion.
/// The drag of relative motion is implicit, too: it uses the velocity of the centre of mass at the end of the
/// step. If the present perimeter makes the area mode too stiff for the time step, the pressure is implicit
/// (see Pressure) where drag is strong and uniform; otherwise steps get shorter.
class DpDroplet final : public Droplet {
 public:
  /// @param run        resolved parameters
  /// @param obstacles  must outlive the droplet
  /// @param initial    vertices and velocities
  DpDroplet(const RunParameters& run, const ObstacleArray& obstacles, DropletState initial);

  ~DpDroplet() override;

  void advance(int num_steps) override;
  void rebuild_lists() override;
  double kinetic_energy() const override;
  Eigen::Array2d centre() const override;
  Eigen::Array2d area_centre() const override { return area_centroid(state_.position); }
  Eigen::Array2d centre_velocity() const override;
  PolygonShape shape() const override { return polygon_shape(state_.position); }
  PotentialEnergy potential_energy() const override { return forces_.energy(state_); }
  const DpForces& forces() const { return forces_; }
  /// See DpForces::deepest_overlap().
  double deepest_overlap() const { return forces_.deepest_overlap(state_); }

 private:
  RunParameters run_;
  DpForces forces_;
  double vertex_mass_;
  std::unique_ptr<DpStepper> stepper_;
};

}  // namespace clog

#pragma once

#include <cstdint>

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/droplet/energy.hpp"
#include "clog/core/droplet/shape.hpp"

namespace clog {

/// Perimeter [sigma] above which a polygon counts as burst. A burst polygon is not integrated any further.
inline constexpr double burst_perimeter = 1000;

/// A moving droplet. A run uses the droplets of both models through this class.
class Droplet {
 public:
  virtual ~Droplet() = default;

  /// Integrates the equations of motion over `num_steps` time steps, splitting them if needed.
  virtual void advance(int num_steps) = 0;

  /// Rebuilds everything that save() does not write: contact lists and sums over them. After this call, a
  /// droplet restored from save() moves exactly like this one.
  virtual void rebuild_lists() = 0;
  void save(ByteWriter& bytes) const;
  /// Restores the state that save() wrote for a droplet with the same parameters and obstacles.
  void restore(ByteReader& bytes);

  /// Number of steps done so far; each sub-step counts as one.
  std::int64_t num_integrated_steps() const { return num_integrated_steps_; }
  const DropletState& state() const { return state_; }
  /// [g rho sigma^3]
  virtual double kinetic_energy() const = 0;
  /// The gravity term measures the height from the frame's origin.
  virtual PotentialEnergy potential_energy() const = 0;
  /// Centre of mass, local [sigma]: the centroid of the area if the weight acts on the area, otherwise the
  /// mean of the vertices.
  virtual Eigen::Array2d centre() const { return state_.centre(); }
  /// Centroid of the area, local [sigma], whatever the parameter `gravity` is.
  virtual Eigen::Array2d area_centre() const { return state_.centre(); }
  /// [sqrt(sigma g)]
  virtual Eigen::Array2d centre_velocity() const { return state_.mean_velocity(); }
  /// Area and perimeter; a soft disk returns those of the undeformed disk.
  virtual PolygonShape shape() const = 0;

  /// After this call, work() adds up the dissipated energy. This costs a pass over the velocities per step.
  void measure_dissipation() { measures_dissipation_ = true; }
  /// Work since measure_dissipation() [g rho sigma^3]: the energy lost to drag, and the work of the springs
  /// along the interface. (The force of these springs derives from no potential energy.) Both are sums by the
  /// trapezoidal rule, which is second order in the time step, like the integrator.
  struct Work {
    double dissipated = 0;
    double spreading = 0;
  };
  const Work& work() const { return work_; }

 protected:
  DropletState state_;
  bool measures_dissipation_ = false;
  Work work_;
  std::int64_t num_integrated_steps_ = 0;
};

}  // namespace clog

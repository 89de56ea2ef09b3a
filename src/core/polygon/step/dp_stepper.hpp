#pragma once

#include <vector>

#include "clog/core/droplet/droplet.hpp"
#include "clog/core/polygon/contact/wall_touches.hpp"
#include "clog/core/polygon/forces/dp_forces.hpp"
#include "dp_step_kernel.hpp"
#include "near_contacts.hpp"
#include "step_memory.hpp"
#include "wall_hold.hpp"
#include "wall_plan.hpp"

namespace clog {

/// Moves a polygon by whole time steps with the vectorised kernel. Between two calls a droplet is its
/// positions and velocities and nothing else.
class DpStepper {
 public:
  /// @param run        resolved parameters
  /// @param obstacles  must outlive this object
  /// @param forces     its contact lists are used; must outlive this object
  DpStepper(const RunParameters& run, const ObstacleArray& obstacles, const DpForces& forces);

  /// Copies the droplet's positions and velocities into the arrays of the step.
  void load(const DropletState& state);
  /// Copies them back, as they are now.
  void store(DropletState& state) const;
  /// Surveys the droplet as it is now, compared with where it was when contact lists were made.
  kernel::Survey survey() const;
  /// Selects from the contact lists what may touch before the next look(). The lists must hold until then.
  /// @param speed  of the fastest vertex; @param state, work  as for advance()
  void look(DropletState& state, const Travel& travel, double speed, Droplet::Work* work);
  /// `steps` steps of `time_step`. The last half kick is left open: positions are those of the steps' end,
  /// velocities those of half a step before.
  /// @param state  the droplet that was loaded, of which walls' anchors are kept; positions and velocities
  /// may be old
  /// @param implicit_pressure  see StableSteps; not with near-wall drag
  /// @param work  if not null, what drag and springs did since the last call is added to it
  void advance(DropletState& state, int steps, double time_step, bool implicit_pressure, Droplet::Work* work);
  /// Makes the last half kick if it is still open; copies positions, velocities and anchors into `state`.
  void finish(DropletState& state, Droplet::Work* work);

 private:
  RunParameters run_;
  const DpForces* forces_;
  kernel::KickTerms terms_;
  kernel::StepKernel kernel_, implicit_kernel_;  // the latter with an implicit pressure
  int n_;
  bool holds_circles_;              // does friction act, and only at edges that meet circles?
  bool are_pushes_spread_ = false;  // did friction push vertices in the last step?
  StepMemory memory_;
  kernel::StepArrays arrays_;
  NearContacts near_;                       // what may touch before the next look
  WallPlan plan_;                           // without holds_circles_
  WallHold hold_;                           // with holds_circles_
  std::vector<kernel::WedgePlace> wedges_;  // in the droplet's frame
  WallTouches touches_;
  WettedWalls::Forces wetting_;
  Eigen::ArrayXd friction_;              // on vertices, all x then all y; zero between steps
  Eigen::Array2d wetting_spread_{0, 0};  // see WettedWalls::Forces
  kernel::Sums sums_{};
  double fastest_ = 0;                    // speed of a vertex at the last look [sqrt(sigma g)]
  int steps_to_rates_ = 0;                // left with the present rates of near-wall drag
  kernel::KickCoefficients rates_for_{};  // with these half steps
  bool has_implicit_pressure_ = false;    // in the present steps
  double open_step_ = 0;                  // length of the step whose last half kick is to come; 0: none is
  Droplet::Work open_power_;              // at its beginning

  void push_off_circles(const kernel::Contact& touching, double impulse, Droplet::Work* work);
  void kick_and_drift(DropletState& droplet, const kernel::KickCoefficients& coefficients, double drift_time,
                      Droplet::Work* work);
  void push_off_everything(DropletState& droplet, const kernel::KickCoefficients& coefficients,
                           double impulse, Droplet::Work* work);
  void renew_rates(const kernel::KickCoefficients& coefficients);
  void add_wetting(DropletState& droplet, double impulse, Droplet::Work* work);
  void hold_by_friction(DropletState& droplet, double impulse, Droplet::Work* work);
  double softening(double half_step) const;  // see KickCoefficients
  double vertex_mass() const;                // that resists a change of speed
  Droplet::Work power(const kernel::InterfaceKick& interface, const kernel::KickCoefficients& coefficients,
                      const kernel::Coupling& coupling) const;
};

}  // namespace clog

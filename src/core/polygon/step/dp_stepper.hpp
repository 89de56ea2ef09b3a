#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "clog/core/droplet/droplet.hpp"
#include "clog/core/polygon/contact/self_crossings.hpp"
#include "clog/core/polygon/contact/wall_touches.hpp"
#include "clog/core/polygon/forces/dp_forces.hpp"
#include "clog/core/polygon/forces/stability.hpp"
#include "dp_step_kernel.hpp"
#include "near_contacts.hpp"
#include "step_memory.hpp"
#include "wall_hold.hpp"
#include "wall_plan.hpp"

namespace clog {

/// A survey finds contacts, speeds and stability. A stepper makes at least one survey in this number of
/// steps.
inline constexpr int most_steps_per_survey = 32;
/// The rates of the near-wall drag are kept for at most this number of steps. During these steps, no vertex
/// may move farther than this fraction of the near-wall cutoff
/// (docs/notes/2026-11-25-rates-of-near-wall-drag.md).
inline constexpr double most_steps_per_rate = 4, farthest_move_per_rate = 0.2;

/// Moves a polygon by whole time steps with the vectorised kernel. The motion in a call depends only on the
/// DropletState at its beginning.
class DpStepper {
 public:
  /// @param run  resolved parameters
  /// @param obstacles  must outlive this object
  /// @param forces  forces of the same run; their contact lists are rebuilt when needed; must outlive this
  /// object
  DpStepper(const RunParameters& run, const ObstacleArray& obstacles, DpForces& forces);

  /// Rebuilds the contact lists of a droplet.
  void rebuild_lists(const DropletState& state);
  /// Moves a droplet by `num_steps` time steps of the run. If these steps would be unstable, it takes more
  /// and shorter steps. It stops if the droplet bursts. Returns the number of steps taken.
  /// @param work  if not null, the work of drag and springs is added to it
  std::int64_t move(DropletState& state, int num_steps, Droplet::Work* work);
  /// Moves a droplet by the given steps. These may have other lengths than the run's steps, and may be
  /// unstable. Possible contacts are surveyed before each entry of `all`. With near-wall drag, the pressure
  /// must not be implicit.
  void move(DropletState& state, std::span<const Steps> all, Droplet::Work* work);

 private:
  /// Possible contacts of the droplet before the next survey.
  struct Near {
    NearContacts contacts{};
    double largest_wall_gap = 0,
           largest_self_gap = 0;  // largest gaps of walls and of pairs up to which `contacts` has entries
    WallPlan plan;                // used if holds_circles_ is false
    WallHold hold;                // used if holds_circles_ is true
    std::vector<kernel::WedgePlace> wedges{};  // wedges in the droplet's frame
  };
  /// Friction on vertices; used if holds_circles_ is false.
  struct VertexFriction {
    WallTouches touches;
    Eigen::ArrayXd force;     // forces, all x then all y; zero between steps
    bool has_pushed = false;  // whether `force` acted in the last step
  };
  struct KeptRates {
    double fastest = 0;  // speed of the fastest vertex at the last survey [sqrt(sigma g)]
    int steps_left = 0;  // number of steps for which the present rates may still be used
    double h1 = 0, h2 = 0;
  };
  /// The last step, if its second half kick is still pending.
  struct OpenStep {
    double length = 0;  // 0 if no half kick is pending
    Pressure pressure = Pressure::present;
    Droplet::Work power;  // power at the beginning of the step
  };
  RunParameters run_;
  DpForces* forces_;
  int n_;
  bool holds_circles_;  // whether there is friction, and only at edges that touch circles
  int steps_per_survey_;
  Pressure most_pressure_;
  kernel::KickTerms terms_;
  kernel::StepKernel kernel_, implicit_kernel_;  // the second one is for an implicit pressure
  StepMemory memory_;
  kernel::Sums sums_{};
  Near near_;
  WettedWalls::Forces wetting_;
  VertexFriction friction_;
  KeptRates rates_;
  OpenStep open_;
  SelfCrossings crossings_;
  double fastest_relative_ = 0;  // relative speed of the fastest vertex at the last survey [sqrt(sigma g)]

  void load(DropletState& state);
  kernel::Survey survey() const;
  void prepare_contacts(DropletState& state, const kernel::Survey& now, double time, Droplet::Work* work);
  void advance(DropletState& state, const Steps& steps, Droplet::Work* work);
  void finish(DropletState& state, Droplet::Work* work);
  void kick_and_drift(DropletState& state, double half_step, double drift_time, Droplet::Work* work);
  double push_off_circles(const kernel::Contact& touching, double impulse, Droplet::Work* work);
  int parts_of_fast_step(double way) const;
  void keep_near_contacts();
  bool follow_crossings(DropletState& state, double nearest_pair);
  void push_back_crossed(const kernel::Contact& touching);
  Contour contour() const;
  void push_off_everything(DropletState& state, const kernel::KickCoefficients& coefficients, double impulse,
                           Droplet::Work* work);
  void update_rates(const kernel::KickCoefficients& coefficients);
  void add_wetting(DropletState& state, double impulse, Droplet::Work* work);
  void hold_by_friction(DropletState& state, double impulse, Droplet::Work* work);
  double vertex_mass() const;  // inertial mass of a vertex
  Droplet::Work power(const kernel::StepKernel& kernel, const kernel::InterfaceKick& interface,
                      const kernel::KickCoefficients& coefficients, const kernel::Coupling& coupling) const;
};

}  // namespace clog

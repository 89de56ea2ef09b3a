#pragma once

#include <utility>

#include "clog/core/polygon/forces/dp_forces.hpp"
#include "core/polygon/step/dp_stepper.hpp"

namespace clog::test {

/// A droplet that is moved by DpStepper itself, in steps of the test's choice, over at most 0.1 sigma where
/// it may touch something.
class SteppedDroplet {
 public:
  /// @param walls  must outlive this  @param work  see DpStepper::advance()
  SteppedDroplet(const RunParameters& run, const ObstacleArray& walls, DropletState initial,
                 Droplet::Work* work = nullptr)
      : forces_(run, walls), stepper_(run, walls, forces_), state_(std::move(initial)), work_(work) {
    forces_.update_contacts(state_, travel_);
    begin();
  }
  /// Leaves the last half kick open.
  void advance(int steps, double time_step, bool implicit_pressure = false) {
    stepper_.advance(state_, steps, time_step, implicit_pressure, work_);
  }
  /// Closes it. What follows begins with a new half kick.
  const DropletState& finish() {
    stepper_.finish(state_, work_);
    begin();
    return state_;
  }
  DpForces& forces() { return forces_; }

 private:
  const Travel travel_{.absolute = 0.1, .relative = 0.2};
  DpForces forces_;
  DpStepper stepper_;
  DropletState state_;
  Droplet::Work* work_;

  void begin() {
    constexpr double speed = 100;  // faster than any vertex: near-wall drag is that of every place
    stepper_.load(state_);
    stepper_.look(state_, travel_, speed, work_);
  }
};

}  // namespace clog::test

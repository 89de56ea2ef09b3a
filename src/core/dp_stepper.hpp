#pragma once

#include <hwy/aligned_allocator.h>

#include <vector>

#include "clog/core/dp_forces.hpp"
#include "clog/core/droplet.hpp"
#include "dp_step_kernel.hpp"

namespace clog {

/// Moves a polygon by whole time steps with the vectorised kernel. Between two calls a droplet is its
/// positions and velocities and nothing else.
class DpStepper {
 public:
  /// @param run     resolved parameters
  /// @param forces  its contact lists are used; must outlive this object
  DpStepper(const RunParameters& run, const DpForces& forces);

  struct Edges {
    double perimeter, shortest;  ///< [sigma]
  };
  /// Takes over a droplet.
  Edges load(const DropletState& state);
  /// `steps` steps of `time_step` of the droplet just loaded. The contact lists must hold for the way.
  /// @param state  that droplet, at the end with its new positions and velocities
  /// @param work  if not null, what drag and springs did is added to it
  void advance(DropletState& state, int steps, double time_step, Droplet::Work* work);
  const char* instruction_set() const { return kernel_.name; }

 private:
  RunParameters run_;
  const DpForces* forces_;
  kernel::KickTerms terms_;
  kernel::StepKernel kernel_;
  int n_;
  hwy::AlignedFreeUniquePtr<double[]> memory_;
  kernel::StepArrays arrays_;
  std::vector<kernel::WedgePlace> wedges_;  // in the droplet's frame
  Eigen::Array2d wetting_spread_{0, 0};     // of wetting, see DpForces::wetting_forces()
  kernel::Sums sums_{};

  void store(DropletState& state) const;
  Droplet::Work kick_and_drift(const DropletState& frame, const kernel::KickCoefficients& coefficients,
                               double drift_time, bool measures_power);
  void push_off_everything(const DropletState& frame, const kernel::KickCoefficients& coefficients,
                           double impulse);
  Droplet::Work power(const kernel::InterfaceKick& interface, const kernel::KickCoefficients& coefficients,
                      const kernel::Coupling& coupling) const;
};

}  // namespace clog

#pragma once

#include <cstdint>
#include <vector>

#include "clog/core/polygon/dp_forces.hpp"
#include "dp_step_kernel.hpp"
#include "step_memory.hpp"
#include "wall_plan.hpp"

namespace clog {

/// The forces of DpForces by the passes of a step, for searches of a rest, which ask for them some thousand
/// times.
class RestForces {
 public:
  /// @param run     resolved parameters
  /// @param forces  of the same run; must outlive this object
  RestForces(const RunParameters& run, DpForces& forces);

  /// See DpForces.
  void update_contacts(const DropletState& state, const Travel& travel) {
    forces_->update_contacts(state, travel);
  }
  /// force = -grad U, all x then all y [g rho sigma^2], to round-off that of DpForces::evaluate().
  void evaluate(const DropletState& state, Eigen::ArrayXd& force);

 private:
  DpForces* forces_;
  int n_;
  kernel::KickTerms terms_;
  kernel::StepKernel kernel_;
  kernel::Contact contact_;
  StepMemory memory_;
  WallPlan plan_;
  std::vector<kernel::WedgePlace> wedges_;
  std::int64_t num_renewals_ = -1;  // of the lists that the plan was made of

  void push_off(const DropletState& state);
};

}  // namespace clog

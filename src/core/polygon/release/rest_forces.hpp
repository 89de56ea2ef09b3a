#pragma once

#include <vector>

#include "clog/core/polygon/forces/dp_forces.hpp"
#include "core/polygon/step/dp_step_kernel.hpp"
#include "core/polygon/step/near_contacts.hpp"
#include "core/polygon/step/step_memory.hpp"
#include "core/polygon/step/wall_plan.hpp"

namespace clog {

/// The negative gradient of DpForces' energy. Releases and searches for an equilibrium need it thousands of
/// times, so this class uses the fast passes of a step.
class RestForces {
 public:
  /// @param run     resolved parameters
  /// @param forces  energy of the same run; must outlive this object
  RestForces(const RunParameters& run, DpForces& forces);

  /// See DpForces.
  void update_contacts(const DropletState& state, const Travel& travel);
  /// force = -grad U, all x then all y [g rho sigma^2].
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
  WettedWalls::Forces wetting_;
  NearContacts near_;
  double way_ = 0;  // displacement up to which the contacts are valid [sigma]
  // Positions at the last update of the contacts: all x, then all y, then padding up to a whole number of
  // SIMD vectors.
  Eigen::ArrayXd looked_at_;

  bool contacts_hold(const Travel& travel) const;
  void look(const DropletState& state, const Travel& travel);
  void start_from_forces_of_walls(const DropletState& state, Eigen::ArrayXd& force);
};

}  // namespace clog

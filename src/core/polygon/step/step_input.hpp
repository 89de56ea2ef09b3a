#pragma once

#include <vector>

#include "clog/core/polygon/forces/dp_forces.hpp"
#include "dp_step_kernel.hpp"

/// Parameters of a step that follow from a run and its forces.
namespace clog {

/// @param far_rate  rate of the drag far from walls [1/t0]; 0: no drag
kernel::KickTerms kick_terms(const RunParameters& run, double far_rate);
/// @param impulse  kick of a vertex by a unit force
kernel::Contact contact_as_kick(const RunParameters& run, const DpForces& forces, double impulse);
/// The terms of the interface as kicks. @param impulse  kick of a vertex by a unit force
kernel::InterfaceKick interface_kick(const InterfaceTerms& interface, double impulse);
/// A force on the area as a kick, including the reaction of the springs along the interface.
kernel::AreaForce area_force(const kernel::Sums& sums, const Eigen::Array2d& kick);
/// The wedges in the coordinates of a droplet.
std::vector<kernel::WedgePlace> wedges_in(const LocalFrame& frame, const std::vector<Wedge>& wedges);

}  // namespace clog

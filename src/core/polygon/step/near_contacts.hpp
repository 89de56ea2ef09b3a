#pragma once

#include <span>
#include <vector>

#include "clog/core/polygon/contact/self_crossings.hpp"
#include "clog/core/polygon/forces/dp_forces.hpp"
#include "dp_step_kernel.hpp"

namespace clog {

/// The entries of the contact lists that may touch before the next survey.
class NearContacts {
 public:
  /// Measures the gaps of all listed entries. Returns the depth of the deepest contact [sigma].
  double measure(const kernel::StepKernel& kernel, const kernel::Contact& contact, const DpForces& forces,
                 const kernel::StepArrays& arrays);
  /// Keeps the entries that measure() found within these distances from contact [sigma].
  void keep(const kernel::StepKernel& kernel, const DpForces& forces, double largest_wall_gap,
            double largest_self_gap);

  /// Removes the given contacts until the next keep(). @param num_vertices  number of the droplet's vertices
  void mute(std::span<const SelfCrossings::Muted> contacts, int num_vertices);

  const std::vector<WallContacts::Item>& walls() const { return walls_; }
  const std::vector<SelfContacts::Item>& self() const { return self_; }

 private:
  std::vector<WallContacts::Item> walls_;
  std::vector<SelfContacts::Item> self_;
  std::vector<double> wall_gaps_, self_gaps_;  // gaps of the items of the lists
};

}  // namespace clog

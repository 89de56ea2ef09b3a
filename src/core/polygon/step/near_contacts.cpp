#include "near_contacts.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>

namespace clog {

double NearContacts::measure(const kernel::StepKernel& kernel, const kernel::Contact& contact,
                             const DpForces& forces, const kernel::StepArrays& arrays) {
  const auto& walls = forces.walls().items();
  const auto& self = forces.self_contacts().items();
  wall_gaps_.resize(walls.size() * std::size_t{kernel::edges_per_group});
  self_gaps_.resize(self.size());
  return -std::min(kernel.circle_gaps(walls.data(), walls.size(), contact, arrays, wall_gaps_.data()),
                   kernel.pair_gaps(self.data(), self.size(), contact, arrays, self_gaps_.data()));
}

void NearContacts::keep(const kernel::StepKernel& kernel, const DpForces& forces, double largest_wall_gap,
                        double largest_self_gap) {
  walls_.clear();
  const auto& walls = forces.walls().items();
  assert(wall_gaps_.size() == walls.size() * std::size_t{kernel::edges_per_group});
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const std::uint8_t edges =
        kernel.edges_within(&wall_gaps_[k * std::size_t{kernel::edges_per_group}], largest_wall_gap);
    if (edges == 0) continue;
    walls_.push_back(walls[k]);
    walls_.back().edges = edges;
  }
  self_.clear();
  const auto& self = forces.self_contacts().items();
  assert(self_gaps_.size() == self.size());
  for (std::size_t k = 0; k < self.size(); ++k)
    if (self_gaps_[k] <= largest_self_gap) self_.push_back(self[k]);
}

void NearContacts::mute(std::span<const SelfCrossings::Muted> contacts, int num_vertices) {
  for (SelfContacts::Item& item : self_)
    for (const auto& [pair, crossing] : contacts) {
      const int bit = pair.edge - item.edges;
      if (bit < 0 || bit >= kernel::edges_per_group) continue;
      const int vertex = item.vertices + (item.backwards ? kernel::edges_per_group - 1 - bit : bit);
      if (vertex % num_vertices == pair.vertex) item.pairs &= static_cast<std::uint8_t>(~(1U << bit));
    }
}

}  // namespace clog

#include "clog/core/jamming.hpp"

#include <numbers>

namespace clog {

double saturated_density(double diameter, double gap) {
  constexpr double jamming_coverage = 0.547069;
  return jamming_coverage / (std::numbers::pi / 4 * (diameter + gap) * (diameter + gap));
}

}  // namespace clog

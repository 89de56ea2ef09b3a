#include "clog/core/droplet/hold.hpp"

namespace clog {
namespace {

/// Fractions of the support that wrapped obstacles give. Up to squeezed_below, the droplet does not count as
/// wrapped. From wrapped_above on, it counts as wrapped; in between, it counts as hybrid.
constexpr double squeezed_below = 1.0 / 3;
constexpr double wrapped_above = 2.0 / 3;

}  // namespace

ClogMechanism ClogGeometry::mechanism() const {
  if (wrapped_support >= wrapped_above) return ClogMechanism::wrapped;
  if (wrapped_support > squeezed_below) return ClogMechanism::hybrid;
  return num_gaps > 0 ? ClogMechanism::squeezed : ClogMechanism::none;
}

}  // namespace clog

#include "clog/core/droplet/hold.hpp"

namespace clog {
namespace {

/// Fractions of the support that wrapped obstacles give. Up to the first fraction, the droplet does not count
/// as wrapped. From the second fraction on, it counts as wrapped, and in between as hybrid.
constexpr double squeezed_below = 1.0 / 3;
constexpr double wrapped_above = 2.0 / 3;

}  // namespace

ClogMechanism ClogGeometry::mechanism() const {
  if (wrapped_support >= wrapped_above) return ClogMechanism::wrapped;
  if (wrapped_support > squeezed_below) return ClogMechanism::hybrid;
  return num_gaps > 0 ? ClogMechanism::squeezed : ClogMechanism::none;
}

}  // namespace clog

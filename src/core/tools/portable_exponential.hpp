#pragma once

#include <boost/random/exponential_distribution.hpp>

#include "clog/core/tools/portable_math.hpp"

/// Replaces the density that Boost's exponential distribution uses by one that is the same on every
/// processor. Boost's density calls std::exp.
template <>
inline double boost::random::detail::unit_exponential_distribution<double>::f(double x) {
  return clog::portable::exp(-x);
}

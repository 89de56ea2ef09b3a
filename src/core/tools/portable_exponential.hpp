#pragma once

#include <boost/random/exponential_distribution.hpp>

#include "clog/core/tools/portable_math.hpp"

/// Replaces the density function of Boost's exponential distribution, which calls std::exp, by a function
/// that gives the same bits on every processor.
template <>
inline double boost::random::detail::unit_exponential_distribution<double>::f(double x) {
  return clog::portable::exp(-x);
}

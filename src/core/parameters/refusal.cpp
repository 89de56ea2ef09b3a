#include "core/parameters/refusal.hpp"

#include <cmath>

#include "clog/core/tools/portable_math.hpp"

namespace clog {

double rounded_down(double value, int digits) {
  const double scale = portable::pow(10, digits - 1 - std::floor(portable::log10(value)));
  return std::floor(value * scale * (1 + 1e-12)) / scale;
}

}  // namespace clog

#include "clog/core/run/steady_record.hpp"

#include <cmath>

namespace clog {

void SteadyRecord::add(double time, double displacement) {
  if (std::isnan(begin_.time) && time >= start_) begin_ = {.distance = displacement, .time = time};
}

SteadyTravel SteadyRecord::until(double time, double displacement) const {
  if (!(time > begin_.time)) return {};
  return {.distance = displacement - begin_.distance, .time = time - begin_.time};
}

}  // namespace clog

#include "clog/core/run/passage.hpp"

namespace clog {

void Passage::add(double place, double shape_parameter, double speed, bool is_falling) {
  // A comparison with NaN is false, so the first value is always taken.
  if (!(shape_parameter <= largest_shape_parameter.value)) largest_shape_parameter = {shape_parameter, place};
  if (!(speed <= largest_speed.value)) largest_speed = {speed, place};
  if (is_falling && !(speed >= smallest_speed.value)) smallest_speed = {speed, place};
}

}  // namespace clog

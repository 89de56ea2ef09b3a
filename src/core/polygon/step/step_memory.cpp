#include "step_memory.hpp"

#include <algorithm>
#include <cstddef>

namespace clog {

StepMemory::StepMemory(int num_vertices) : n_(num_vertices) {
  // Every array on a cache line, with room for an entry before and a group behind it.
  constexpr int line = 8;
  const int stride = (n_ + line - 1) / line * line + 3 * line;
  const auto size = static_cast<std::size_t>(kernel::num_step_arrays) * static_cast<std::size_t>(stride);
  memory_ = aligned_zeros(size);
  double* next = memory_.get() + line;
  for (double** array :
       {&arrays_.x,         &arrays_.y,       &arrays_.vx,      &arrays_.vy,       &arrays_.tangent_x,
        &arrays_.tangent_y, &arrays_.length,  &arrays_.push_x,  &arrays_.push_y,   &arrays_.wetting_x,
        &arrays_.wetting_y, &arrays_.grad_xx, &arrays_.grad_xy, &arrays_.grad_yx,  &arrays_.grad_yy,
        &arrays_.rate,      &arrays_.damping, &arrays_.kept,    &arrays_.kicked_x, &arrays_.kicked_y,
        &arrays_.chord_x,   &arrays_.chord_y}) {
    *array = next;
    next += stride;
  }
  // Edges of the last group that do not exist are divided by as well.
  std::fill_n(arrays_.length, stride - line, 1.0);
}

void StepMemory::load(const double* from, double* to) const {
  std::copy_n(from, n_, to);
  to[-1] = to[n_ - 1];
  std::copy_n(to, kernel::edges_per_group, to + n_);
}

}  // namespace clog

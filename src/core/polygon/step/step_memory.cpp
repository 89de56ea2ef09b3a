#include "step_memory.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace clog {

StepMemory::StepMemory(int num_vertices) : n_(num_vertices) {
  assert(n_ >= kernel::edges_per_group);
  // Arrays begin on cache lines. There is room for an entry before each array, and for a group after it.
  constexpr int line = 8;
  const int stride = (n_ + line - 1) / line * line + 3 * line;
  memory_ = aligned_zeros(sizeof arrays_ / sizeof(kernel::ContourArray) * static_cast<std::size_t>(stride));
  double* next = memory_.get() + line - stride;
  const auto array = [&]() -> kernel::ContourArray { return {next += stride}; };
  const auto pair = [&]() -> kernel::ContourPair { return {array(), array()}; };
  arrays_ = {pair(), pair(),  pair(),  array(), pair(), pair(), pair(),
             pair(), array(), array(), array(), pair(), pair()};
  // If the last group is not full, the passes also divide by the lengths of its missing edges. So these
  // lengths must not be 0.
  std::fill_n(arrays_.length.first, stride - line, 1.0);
}

void StepMemory::load(const Eigen::ArrayXd& from, const kernel::ContourPair& to) const {
  assert(from.size() == 2 * n_);
  const double* source = from.data();
  for (const kernel::ContourArray& array : {to.x, to.y}) {
    std::copy_n(source, n_, array.first);
    array[-1] = array[n_ - 1];
    std::copy_n(array.first, kernel::edges_per_group, array + n_);
    source += n_;
  }
}

void StepMemory::store(const kernel::ContourPair& from, Eigen::ArrayXd& to) const {
  assert(to.size() == 2 * n_);
  std::copy_n(from.x.first, n_, to.data());
  std::copy_n(from.y.first, n_, to.data() + n_);
}

}  // namespace clog

#pragma once

#include "aligned_memory.hpp"
#include "dp_step_kernel.hpp"

namespace clog {

/// The arrays of a step: zero, except for the lengths of edges, which are 1.
class StepMemory {
 public:
  explicit StepMemory(int num_vertices);
  const kernel::StepArrays& arrays() const { return arrays_; }
  kernel::StepArrays& arrays() { return arrays_; }
  /// Copies one number for each vertex into an array, and repeats the contour beyond its ends.
  void load(const double* from, double* to) const;

 private:
  int n_;
  hwy::AlignedFreeUniquePtr<double[]> memory_;
  kernel::StepArrays arrays_{};
};

}  // namespace clog

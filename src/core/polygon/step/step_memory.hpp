#pragma once

#include <Eigen/Core>

#include "aligned_memory.hpp"
#include "dp_step_kernel.hpp"

namespace clog {

/// The arrays of a step. At first they are zero, except for the lengths of edges, which are 1.
class StepMemory {
 public:
  explicit StepMemory(int num_vertices);
  const kernel::StepArrays& arrays() const { return arrays_; }
  kernel::StepArrays& arrays() { return arrays_; }
  /// Copies one vector for each vertex (all x, then all y) into arrays, and repeats the contour beyond its
  /// ends.
  void load(const Eigen::ArrayXd& from, const kernel::ContourPair& to) const;
  void store(const kernel::ContourPair& from, Eigen::ArrayXd& to) const;

 private:
  int n_;
  hwy::AlignedFreeUniquePtr<double[]> memory_;
  kernel::StepArrays arrays_{};
};

}  // namespace clog

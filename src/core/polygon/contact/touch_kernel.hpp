#pragma once

#include <cstddef>

#include "clog/core/polygon/contact/wall_contacts.hpp"

/// The arithmetic of WallTouches, for a vector of edges or vertices at once. Compiled for several instruction
/// sets and without fused multiply-adds: the same numbers, bit for bit, with each of them.
namespace clog::kernel {

struct Circle {
  double x, y;
  double reach;  ///< radius + range [sigma]
};

/// What a circle does to the consecutive edges of a group. An edge decides, with its two neighbours, where
/// the middle of the refined contour is (see refined()), so that a push on it goes to four vertices.
struct GroupTouches {
  static constexpr int edges = WallContacts::edges_per_group;
  /// On the vertex before the edge, on its own two, on the one behind [g rho sigma^2].
  alignas(64) double push_x[4][edges];
  alignas(64) double push_y[4][edges];
  /// Length of the edge on the circle that is its first, its second vertex' [sigma].
  alignas(64) double wetted[2][edges];
  unsigned touching;  ///< edges that touch, as bits; the others' entries mean nothing
};

struct TouchKernel {
  /// @param x, y  of the group's first vertex; read from one vertex before to two behind the group
  void (*touch)(const double* x, const double* y, const Circle& circle, double stiffness,
                GroupTouches& touches);
  /// Computes directions of `n` vectors, and `numerators` by their lengths. Arrays are read and written up to
  /// a whole number of groups.
  void (*directions)(std::size_t n, const double* x, const double* y, const double* numerators,
                     double* direction_x, double* direction_y, double* ratios);
};

/// The kernel for this processor's widest instruction set, or for that of use_instruction_set().
TouchKernel touch_kernel();

}  // namespace clog::kernel

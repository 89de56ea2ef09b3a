#pragma once

#include <cstddef>

#include "clog/core/polygon/contact/wall_contacts.hpp"

/// The arithmetic of WallTouches for a vector of edges or vertices. The code is compiled for several
/// instruction sets, but without fused multiply-adds, so that all sets give the same bits.
namespace clog::kernel {

struct Circle {
  double x, y;
  double reach;  ///< radius + range [sigma]
};

/// The effect of a circle on the consecutive edges of a group. The middle of an edge of the refined contour
/// depends on the edge and its two neighbours (see refined()), so a force on the middle acts on four
/// vertices.
struct GroupTouches {
  static constexpr int edges = WallContacts::edges_per_group;
  /// Forces on the vertex before the edge, on the edge's two vertices, and on the vertex after the edge [g
  /// rho sigma^2].
  alignas(64) double push_x[4][edges];
  alignas(64) double push_y[4][edges];
  /// Parts of the edge's wetted length that belong to its first and to its second vertex [sigma].
  alignas(64) double wetted[2][edges];
  unsigned touching;  ///< bits of the edges in contact; the entries of other edges are undefined
};

struct TouchKernel {
  /// @param x, y  coordinates of the group's vertices; the kernel also reads one vertex before the group and
  /// two vertices after it
  void (*touch)(const double* x, const double* y, const Circle& circle, double stiffness,
                GroupTouches& touches);
  /// Computes the directions of `n` vectors, and `numerators` divided by the lengths of the vectors. Arrays
  /// are read and written up to a whole number of groups.
  void (*directions)(std::size_t n, const double* x, const double* y, const double* numerators,
                     double* direction_x, double* direction_y, double* ratios);
};

/// The kernel for this processor's widest instruction set, or for the set that use_instruction_set() has
/// selected.
TouchKernel touch_kernel();

}  // namespace clog::kernel

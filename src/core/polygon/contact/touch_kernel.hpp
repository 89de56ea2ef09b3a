#pragma once

#include <cstddef>

#include "clog/core/polygon/contact/wall_contacts.hpp"

/// The arithmetic of WallTouches for a vector of edges or vertices. It is compiled for several instruction
/// sets, without fused multiply-adds, so that all give the same bits.
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
  /// Forces on the vertex before the edge, on the edge's two vertices, and on the vertex after it [g rho
  /// sigma^2].
  alignas(64) double push_x[4][edges];
  alignas(64) double push_y[4][edges];
  /// Parts of the edge's wetted length that belong to its first and to its second vertex [sigma].
  alignas(64) double wetted[2][edges];
  unsigned touching;  ///< bits of the edges in contact; the entries of other edges are undefined
};

struct TouchKernel {
  /// @param x, y  coordinates of the vertices from the group's first one on; the kernel reads from one vertex
  /// before the group to two after it
  void (*touch)(const double* x, const double* y, const Circle& circle, double stiffness,
                GroupTouches& touches);
  /// Computes directions of `n` vectors, and `numerators` divided by their lengths. Arrays are read and
  /// written up to a whole number of groups.
  void (*directions)(std::size_t n, const double* x, const double* y, const double* numerators,
                     double* direction_x, double* direction_y, double* ratios);
};

/// The kernel for this processor's widest instruction set, or for the one set by use_instruction_set().
TouchKernel touch_kernel();

}  // namespace clog::kernel

#pragma once

#include <vector>

#include "clog/core/polygon/contact/self_contacts.hpp"

/// Finds the parts of a contour that are near each other. Compiled for several instruction sets, all of which
/// find the same pairs.
namespace clog::kernel {

/// A closed contour. Arrays repeat it beyond its end for `close_vertices_beyond` entries, where `along`
/// continues.
struct CloseSearch {
  int n;
  const double *x, *y;
  const double* along;  ///< distance along the contour from vertex 0 [sigma]
  double longest_edge, reach;
  int exclusion;
  double arc;
};
inline constexpr int close_vertices_beyond = 24;

/// Finds all pairs of vertices within `reach` that are at least `exclusion` vertices, or at least `arc`,
/// apart along the contour, each once.
/// @param groups  memory
void find_close_vertices(const CloseSearch& search, std::vector<double>& groups,
                         std::vector<VertexPair>& pairs);

}  // namespace clog::kernel

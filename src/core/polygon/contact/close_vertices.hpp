#pragma once

#include <vector>

#include "clog/core/polygon/contact/self_contacts.hpp"

/// Finds the parts of a contour that are near each other. The code is compiled for several instruction sets;
/// all of them find the same pairs.
namespace clog::kernel {

/// A closed contour. The arrays repeat the beginning of the contour in `close_vertices_beyond` entries beyond
/// its end. In these entries, `along` continues to grow.
struct CloseSearch {
  int n;
  const double *x, *y;
  const double* along;  ///< distance along the contour from vertex 0 [sigma]
  double longest_edge, reach;
  int exclusion;
  double arc;
};
inline constexpr int close_vertices_beyond = 24;

/// Finds every pair of vertices that are within `reach` of each other. Each pair is found once. The vertices
/// of a pair must be at least `exclusion` vertices or at least the distance `arc` apart along the contour.
/// @param groups  working memory
void find_close_vertices(const CloseSearch& search, std::vector<double>& groups,
                         std::vector<VertexPair>& pairs);

}  // namespace clog::kernel

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "clog/core/parameters/parameters.hpp"
#include "clog/core/world/wedge.hpp"

namespace clog {

/// Circles sorted into the square cells of a grid, row by row.
struct BinnedObstacles {
  Period period;
  double largest_radius = 0;  ///< [sigma]
  std::span<const Obstacle> obstacles;
  /// Index of each cell's first obstacle; at the end, the number of obstacles.
  std::span<const std::uint32_t> cell_start;
};

/// Periodic array of circles in a rectangle. The circles are sorted into cells of about one droplet diameter,
/// so that finding the neighbourhood of a droplet costs the same for any period. There may also be wedges,
/// without periodic images.
class ObstacleArray {
 public:
  /// @param obstacles  centres are wrapped into one period, [0, along) x [0, across)
  /// @throws Error if a centre is not finite or a radius not positive and finite
  ObstacleArray(const Period& period, std::vector<Obstacle> obstacles, std::vector<Wedge> wedges = {});

  /// An equal array that uses the memory of another array's binned(). This memory may belong to another
  /// process.
  /// @param memory  keeps that memory alive
  ObstacleArray(const BinnedObstacles& binned, std::shared_ptr<const void> memory);
  const BinnedObstacles& binned() const { return binned_; }
  static std::size_t num_cells(const Period& period);

  const Period& period() const { return binned_.period; }
  /// All obstacles, ordered by cell.
  std::span<const Obstacle> obstacles() const { return binned_.obstacles; }
  const std::vector<Wedge>& wedges() const { return wedges_; }

  /// Appends to `out` every obstacle, periodic images included, with a surface that may come within `margin`
  /// of the rectangle [x_min, x_max] x [y_min, y_max]. All coordinates are relative to `origin`, a point of
  /// the first period. Obstacles that are a little farther away may be included.
  struct Window {
    double origin_x, origin_y;
    double x_min, x_max, y_min, y_max;
    double margin;
  };
  void gather(const Window& window, std::vector<Obstacle>& out) const;

  /// Two obstacles and the surface-to-surface distance between them, periodic images included [sigma];
  /// negative if they overlap.
  struct Pair {
    Obstacle first, second;
    double gap;
  };
  /// The post of each obstacle. Two circles belong to one post if the centre of one is within the other. A
  /// post has the outline of the union of its circles. Circles with exactly the same centre form separate
  /// posts.
  std::vector<std::uint32_t> posts() const;
  /// Whether a post surrounds this place, alone or together with a wall that it touches. In user-supplied
  /// files, circles in a row may form the outline of a post. The inside of such a post is solid. Posts that
  /// are wider than a period surround nothing.
  bool is_within_post(const Eigen::Array2d& place) const;
  /// The two posts with the smallest gap. Periodic images count, except those beyond side walls. The gap is
  /// infinite if no pair is nearer than a box.
  Pair closest_pair() const;
  double smallest_gap() const { return closest_pair().gap; }

 private:
  BinnedObstacles binned_;
  std::shared_ptr<const void> memory_;  // keeps the memory of the obstacles alive
  std::vector<Wedge> wedges_;

  std::uint32_t cell_of(double x, double y) const;
  std::vector<Eigen::Array2d> places_in_posts() const;
  /// Sorts the obstacles by cell, and returns where each cell starts.
  std::vector<std::uint32_t> bin(std::vector<Obstacle>& obstacles) const;
  /// Calls visit(index, x, y) for every obstacle and image that gather() would return.
  template <class Visit>
  void visit_window(const Window& window, Visit visit) const;
};

/// The post of each of a few circles. Posts are numbered from 0 in the order in which they first appear.
/// Unlike ObstacleArray::posts(), this function considers only the given circles. So circles of one post
/// count as several posts if only circles that are not given connect them.
std::vector<int> posts_among(std::span<const Obstacle> circles);

/// A Poisson-disk sample by random sequential addition. Discs are proposed one by one, at uniform places in
/// the period and with diameters uniform in diameter (1 -+ spread). A disc is accepted if its surface is at
/// least `gap` away from the surfaces of all earlier discs. So in dense mixtures, small discs are more
/// frequent among the accepted discs than among the proposed discs. With a density, sampling stops at
/// round(density * area) obstacles. Without a density, it stops when not even a disc of the smallest diameter
/// fits. Such an array is called saturated: at this jamming limit, discs of diameter + gap cover 0.547 of the
/// plane (Feder, J. Theor. Biol. 87, 237 (1980)). Voids are tracked on a flat quadtree as in Ebeida et al.,
/// Comput. Graph. Forum 31, 785 (2012).
/// @throws Error if the density cannot be reached; resolve() accepts only densities that every seed reaches
ObstacleArray sample_obstacles(const ObstacleParameters& parameters, std::uint32_t seed);

}  // namespace clog

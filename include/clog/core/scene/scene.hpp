#pragma once

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// The result of runs in a scene.
enum class Finding { clogging_length, passage, sag };

/// The source of the walls.
enum class WallsFrom {
  parameters,  ///< the parameters of the obstacles alone; sampling an array may take long
  circles,     ///< circles that a user gave
  droplet  ///< the droplet's parameters, which determine the places of the walls; making the walls takes no
           ///< time
};

/// Defines which obstacles a droplet meets, where it starts, and where its path ends. There is one scene for
/// each ObstacleLayout. A new scene needs an enumerator of ObstacleLayout, a file that defines its Scene, a
/// line in scene.cpp, and the steps of docs/developer/add-a-scene.md.
struct Scene {
  Finding finding;
  WallsFrom walls_from;
  /// Whether the array is random. The period of a random array limits the results, because after one period a
  /// droplet meets the same obstacles again.
  bool is_random;
  /// Key of the parameter that is the width of the gaps or the orifice; nullptr if there is none.
  const char* gap_key;

  /// Refuses impossible combinations before automatic values are known; check_each() has checked each
  /// parameter alone. @throws Error
  void (*check)(const RunParameters& run);
  /// Computes the values that follow from other values. Refuses given values that contradict the computed
  /// ones.
  /// @throws Error
  void (*resolve)(RunParameters& run);
  /// Diameter of the sharpest expected bend of the interface [sigma].
  double (*sharpest_bend)(const RunParameters& run);
  /// Obstacles per area [1/sigma^2]; NaN without obstacles, or if the density is unknown before the array is
  /// made.
  double (*density)(const ObstacleParameters& obstacles);

  // The functions from here on take resolved parameters.
  ObstacleArray (*walls)(const RunParameters& run);
  /// A droplet at rest. @throws Error if there is no room for it
  DropletState (*release)(const RunParameters& run, const ObstacleArray& walls);
  /// Displacement along the flow after which the droplet has passed [sigma]; infinite if no droplet can pass.
  /// @param start  place of release of the centre of mass, in the coordinates of the walls [sigma]
  double (*passing_distance)(const RunParameters& run, const Eigen::Array2d& start);
  /// Converts a place from the coordinates of the walls to those of the file of circles, in the first period
  /// [sigma]; nullptr without a file.
  Eigen::Array2d (*place_in_file)(const RunParameters& run, const Eigen::Array2d& place) = nullptr;
};

/// The x at which the path of a droplet released at `x` begins, in the coordinates of the file of circles
/// [sigma]. The void nearest to an entrance may be across the border of the array. In this case the result is
/// the x of the droplet's periodic image that is nearest to the entrance.
double start_of_path(const ObstacleParameters& obstacles, double x);

/// Whether a droplet was released in the nearest void, because an obstacle covers its place on the entrance.
/// @param x, y  place of the release, in the coordinates of the file of circles [sigma]
bool is_displaced(const RunParameters& run, double x, double y);

const Scene& scene_of(ObstacleLayout layout);
const Scene& scene_of(const RunParameters& run);

extern const Scene random_array_scene, lattice_scene, own_circles_scene, channel_scene, wall_scene;

}  // namespace clog

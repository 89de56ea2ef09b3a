#pragma once

#include "clog/core/droplet/droplet_state.hpp"
#include "clog/core/parameters/parameters.hpp"
#include "clog/core/world/obstacle_array.hpp"

namespace clog {

/// The result that runs in a scene are made for.
enum class Finding { clogging_length, passage, sag };

/// The source of the walls.
enum class WallsFrom {
  parameters,  ///< of the obstacles alone; they may take long to sample
  circles,     ///< that a user gave
  droplet      ///< where they stand depends on it; they are made at once
};

/// What a droplet meets, where it starts, and where its way ends. There is one scene for each ObstacleLayout:
/// a new one is a word of that, a file with a scene of its own, a line in scene.cpp, and what
/// docs/developer/add-a-scene.md says besides.
struct Scene {
  Finding finding;
  WallsFrom walls_from;
  /// Is an array random, so that a droplet that has travelled a period meets what it met before?
  bool is_random;
  /// Key of the parameter that says how narrow it is; nullptr without any.
  const char* gap_key;

  /// Refuses what cannot be, before any automatic value is known: of each parameter alone, check_each() has
  /// looked at it. @throws Error
  void (*check)(const RunParameters& run);
  /// Replaces what follows from the others, and refuses what cannot be once these are known. @throws Error
  void (*resolve)(RunParameters& run);
  /// Diameter of the sharpest bend that the interface is expected to take [sigma].
  double (*sharpest_bend)(const RunParameters& run);
  /// Obstacles per area [1/sigma^2]; NaN if there are none, or only the array itself could tell.
  double (*density)(const ObstacleParameters& obstacles);

  // For resolved parameters:
  ObstacleArray (*walls)(const RunParameters& run);
  /// A droplet at rest. @throws Error if there is no room for it
  DropletState (*release)(const RunParameters& run, const ObstacleArray& walls);
  /// Displacement along the flow after which the droplet has passed [sigma]; infinite where it never has.
  /// @param start  where the centre of mass is released, in the coordinates of the walls [sigma]
  double (*way)(const RunParameters& run, const Eigen::Array2d& start);
  /// A place of the walls in the coordinates of the file that these are from; nullptr without a file [sigma].
  Eigen::Array2d (*place_in_file)(const RunParameters& run, const Eigen::Array2d& place) = nullptr;
};

const Scene& scene_of(ObstacleLayout layout);
const Scene& scene_of(const RunParameters& run);

extern const Scene random_array_scene, lattice_scene, own_circles_scene, channel_scene, wall_scene;

}  // namespace clog

#include "clog/core/scene/scene.hpp"

#include <stdexcept>

namespace clog {

const Scene& scene_of(ObstacleLayout layout) {
  switch (layout) {
    case ObstacleLayout::random:
      return random_array_scene;
    case ObstacleLayout::lattice:
      return lattice_scene;
    case ObstacleLayout::file:
      return own_circles_scene;
    case ObstacleLayout::channel:
      return channel_scene;
    case ObstacleLayout::wall:
      return wall_scene;
  }
  throw std::logic_error("a layout without a scene");
}

const Scene& scene_of(const RunParameters& run) { return scene_of(run.obstacles.layout); }

}  // namespace clog

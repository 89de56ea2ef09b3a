#include <utility>

#include "clog/core/scene/release.hpp"
#include "clog/core/scene/scene.hpp"
#include "core/scene/open_box.hpp"
#include "core/scene/sampled_arrays.hpp"

namespace clog {

DropletState at_rest(Eigen::ArrayXd droplet, const Eigen::Array2d& place) {
  DropletState state;
  state.position = std::move(droplet);
  state.velocity = Eigen::ArrayXd::Zero(state.position.size());
  state.frame.period = {open_box, open_box};
  state.frame.shift(place.floor());
  state.x() += place[0] - state.frame.origin[0];
  state.y() += place[1] - state.frame.origin[1];
  return state;
}

namespace {

// A flat wall, and a circular droplet that touches it, under no weight so far: its way to rest under gravity
// is the sag delta_s (Cheng et al., Fig. 7b).

void nothing_to_check(const RunParameters&) {}
void nothing_to_resolve(RunParameters&) {}

/// As among obstacles of the usual size: sags are there to be compared with droplets in such arrays.
double usual_diameter(const RunParameters& run) { return run.obstacles.smallest_diameter(); }

ObstacleArray flat_wall(const RunParameters& run) {
  const Wedge wall{.tip = middle_of_open_box() + Eigen::Array2d(reach(run, free_droplet(run)), 0),
                   .axis = {1, 0}};
  return ObstacleArray(open_box, {}, {wall});
}

DropletState touching(const RunParameters& run, const ObstacleArray&) {
  return at_rest(free_droplet(run), middle_of_open_box());
}

}  // namespace

const Scene wall_scene = {nothing_to_check, nothing_to_resolve, usual_diameter,
                          flat_wall,        touching,           endless_way};

}  // namespace clog

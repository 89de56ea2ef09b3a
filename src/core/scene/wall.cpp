#include <utility>

#include "clog/core/droplet/release.hpp"
#include "clog/core/model/model.hpp"
#include "clog/core/scene/scene.hpp"
#include "core/scene/arrays.hpp"
#include "core/scene/open_box.hpp"

namespace clog {

namespace {

// In this scene a circular droplet without weight touches a flat wall. Then gravity acts; the droplet's
// displacement until it rests is the sag delta_s (Cheng et al., Fig. 7b).

void nothing_to_check(const RunParameters&) {}
void nothing_to_resolve(RunParameters&) {}

ObstacleArray flat_wall(const RunParameters& run) {
  const Wedge wall{.tip = middle_of_open_box() + Eigen::Array2d(model_of(run).reach(run), 0), .axis = {1, 0}};
  return {open_box, {}, {wall}};
}

DropletState touching(const RunParameters& run, const ObstacleArray&) {
  return state_at_rest(model_of(run).free_shape(run), middle_of_open_box(), period_of_open_box());
}

}  // namespace

const Scene wall_scene = {.finding = Finding::sag,
                          .walls_from = WallsFrom::droplet,
                          .is_random = false,
                          .gap_key = nullptr,
                          .check = nothing_to_check,
                          .resolve = nothing_to_resolve,
                          // With this value, automatic parameters are those of a droplet among obstacles of
                          // the usual size. So the sag applies to the droplets in an array.
                          .sharpest_bend = smallest_diameter,
                          .density = no_density,
                          .walls = flat_wall,
                          .release = touching,
                          .passing_distance = infinite_passing_distance};

}  // namespace clog

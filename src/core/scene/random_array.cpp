#include <cmath>
#include <limits>

#include "clog/core/scene/release.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/units.hpp"
#include "clog/core/world/jamming.hpp"
#include "core/scene/refusal.hpp"
#include "core/scene/sampled_arrays.hpp"

namespace clog {

void check_spacing(const RunParameters& run) {
  const ObstacleParameters& obstacles = run.obstacles;
  const double spread = obstacles.diameter_spread;
  const double spacing = obstacles.smallest_diameter() + obstacles.gap;
  const double widest_spacing = obstacles.largest_diameter() + obstacles.gap;
  require(widest_spacing <= 5 * spacing, "obstacle-diameter-spread", spread, [&] {
    return "the largest two obstacles keep " + rounded_text(widest_spacing / spacing) +
           " times the distance of the smallest two: sampling would take hours) use " +
           rounded_text(0.999 * 2 / 3 * (1 + obstacles.gap / obstacles.diameter)) +
           " or less, or a wider obstacle-gap";
  });
  require(widest_spacing <= obstacles.box / 2, "box", obstacles.box, [&] {
    return "holds no two obstacles of diameter " + rounded_text(obstacles.largest_diameter()) + " with gap " +
           rounded_text(obstacles.gap) + ") use at least " + rounded_text(2 * widest_spacing);
  });
  const double largest_box = 1e4 * spacing / std::sqrt(obstacles.boxes);
  require(obstacles.box <= largest_box, "box", obstacles.box, [&] {
    return "the array would need more than ten gigabytes) use at most " + rounded_text(largest_box) +
           "; the array is periodic";
  });
  if (run.model == Model::dp) {
    const double vertex_diameter = units::regular_edge_length(run.dp.vertices);
    require(obstacles.gap > vertex_diameter, "obstacle-gap", obstacles.gap, [&] {
      return "not wider than an edge is long, " + rounded_text(vertex_diameter) +
             " sigma: nothing of the passage would be resolved) widen the gap or use more vertices";
    });
  }
}

double endless_way(const RunParameters&) { return std::numeric_limits<double>::infinity(); }

namespace {

/// Whether a density comes out must not depend on the seed: a sweep would find out row by row.
void check_density(RunParameters& run) {
  const ObstacleParameters& obstacles = run.obstacles;
  if (!obstacles.density) return;
  const double largest = largest_density(obstacles);
  // The value in the message, rounded, may be the least bit larger.
  require(*obstacles.density <= (1 + 1e-9) * largest, "obstacle-density", *obstacles.density, [&] {
    return "more than every seed finds room for, with obstacle-gap=" + rounded_text(obstacles.gap) +
           " and box=" + rounded_text(obstacles.box) + ") use at most " +
           rounded_text(rounded_down(largest, 4), 4) + ", or saturated: as many as fit";
  });
}

double smallest_diameter(const RunParameters& run) { return run.obstacles.smallest_diameter(); }

ObstacleArray sample(const RunParameters& run) { return sample_obstacles(run.obstacles, run.seed); }

}  // namespace

const Scene random_array_scene = {check_spacing, check_density,   smallest_diameter,
                                  sample,        release_droplet, endless_way};

}  // namespace clog

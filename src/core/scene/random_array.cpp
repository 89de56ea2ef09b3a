#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/units.hpp"
#include "clog/core/world/jamming.hpp"
#include "core/parameters/refusal.hpp"
#include "core/scene/arrays.hpp"

namespace clog {

namespace {

/// Whether a density comes out must not depend on the seed: a sweep would find out row by row.
void check_density(RunParameters& run) {
  const ObstacleParameters& obstacles = run.obstacles;
  if (!obstacles.density) return;
  const double largest = largest_density(obstacles);
  // The value in the message, rounded, may be the least bit larger.
  require(*obstacles.density <= (1 + 1e-9) * largest, "obstacle-density", *obstacles.density, [&] {
    return fmt::format(
        "more than every seed finds room for, with obstacle-gap={:.3g} and box={:.3g}) use at most "
        "{:.4g}, or saturated: as many as fit",
        obstacles.gap, obstacles.box, rounded_down(largest, 4));
  });
}

ObstacleArray sample(const RunParameters& run) { return sample_obstacles(run.obstacles, run.seed); }

double density(const ObstacleParameters& obstacles) {
  constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
  if (!obstacles.density && obstacles.diameter_spread > 0) return not_known;
  return obstacles.density.value_or(saturated_density(obstacles.diameter, obstacles.gap));
}

}  // namespace

const Scene random_array_scene = {.finding = Finding::clogging_length,
                                  .walls_from = WallsFrom::parameters,
                                  .is_random = true,
                                  .gap_key = "obstacle-gap",
                                  .check = check_spacing,
                                  .resolve = check_density,
                                  .sharpest_bend = smallest_diameter,
                                  .density = density,
                                  .walls = sample,
                                  .release = release_in_void,
                                  .way = endless_way};

}  // namespace clog

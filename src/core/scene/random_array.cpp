#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <optional>

#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/units.hpp"
#include "clog/core/world/jamming.hpp"
#include "core/parameters/refusal.hpp"
#include "core/scene/arrays.hpp"

namespace clog {

namespace {

/// Converts a share of the saturated density to a density. Refuses densities that only some seeds reach,
/// because single runs of a sweep would then fail.
void find_density(RunParameters& run) {
  ObstacleParameters& obstacles = run.obstacles;
  const std::optional<double> density = wanted_density(obstacles);
  if (!density) return;
  const double largest = largest_density(obstacles);
  // A user may copy the density that the message prints. It may exceed `largest` by the last bit.
  if (*density > (1 + 1e-9) * largest)
    refuse("obstacle-density", density_text(obstacles.density),
           fmt::format(
               "more than every seed finds room for, with obstacle-gap={:.3g} and box={:.3g}) use at most "
               "{:.4g}, or saturated: as many as fit",
               obstacles.gap, obstacles.box, rounded_down(largest, 4)),
           {"obstacle-gap", "box"});
  obstacles.density = *density;
}

ObstacleArray sample(const RunParameters& run) { return sample_obstacles(run.obstacles, run.seed); }

double random_density(const ObstacleParameters& obstacles) {
  constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
  if (obstacles.density.is_saturated() && obstacles.diameter_spread > 0) return not_known;
  return wanted_density(obstacles).value_or(saturated_density(obstacles.diameter, obstacles.gap));
}

}  // namespace

const Scene random_array_scene = {.finding = Finding::clogging_length,
                                  .walls_from = WallsFrom::parameters,
                                  .is_random = true,
                                  .gap_key = "obstacle-gap",
                                  .check = check_spacing,
                                  .resolve = find_density,
                                  .sharpest_bend = smallest_diameter,
                                  .density = random_density,
                                  .walls = sample,
                                  .release = release_in_void,
                                  .passing_distance = infinite_passing_distance};

}  // namespace clog

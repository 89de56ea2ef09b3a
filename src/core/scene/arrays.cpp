#include "core/scene/arrays.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "clog/core/model/model.hpp"
#include "clog/core/tools/number_text.hpp"
#include "core/parameters/refusal.hpp"

namespace clog {

std::string density_text(const ObstacleDensity& density) {
  if (density.share) return share_text(*density.share);
  return density.per_area ? shortest(*density.per_area) : "saturated";
}

void check_box(const ObstacleParameters& obstacles) {
  require(obstacles.box >= narrowest_period, "box", obstacles.box, [&] {
    return fmt::format("the droplet would meet its own periodic image) use at least {}", narrowest_period);
  });
}

void check_spacing(const RunParameters& run) {
  const ObstacleParameters& obstacles = run.obstacles;
  check_box(obstacles);
  const double spread = obstacles.diameter_spread;
  const double spacing = obstacles.smallest_diameter() + obstacles.gap;
  const double widest_spacing = obstacles.largest_diameter() + obstacles.gap;
  require(widest_spacing <= 5 * spacing, "obstacle-diameter-spread", spread, [&] {
    return fmt::format(
        "the largest two obstacles keep {:.3g} times the distance of the smallest two: sampling would "
        "take hours) use {:.3g} or less, or a wider obstacle-gap",
        widest_spacing / spacing, 0.999 * 2 / 3 * (1 + obstacles.gap / obstacles.diameter));
  });
  require(widest_spacing <= obstacles.box / 2, "box", obstacles.box, [&] {
    return fmt::format("holds no two obstacles of diameter {:.3g} with gap {:.3g}) use at least {:.3g}",
                       obstacles.largest_diameter(), obstacles.gap, 2 * widest_spacing);
  });
  const double largest_box = 1e4 * spacing / std::sqrt(obstacles.boxes);
  require(obstacles.box <= largest_box, "box", obstacles.box, [&] {
    return fmt::format(
        "the array would need more than ten gigabytes) use at most {:.3g}; the array is periodic",
        largest_box);
  });
  const double narrowest = model_of(run).narrowest(run);
  require(obstacles.gap > narrowest, "obstacle-gap", obstacles.gap, [&] {
    return fmt::format(
        "not wider than an edge is long, {:.3g} sigma: nothing of the passage would be resolved) "
        "widen the gap or use more vertices",
        narrowest);
  });
}

double smallest_diameter(const RunParameters& run) { return run.obstacles.smallest_diameter(); }

DropletState release_in_void(const RunParameters& run, const ObstacleArray& obstacles) {
  return model_of(run).release(run, obstacles);
}

double infinite_passing_distance(const RunParameters&, const Eigen::Array2d&) {
  return std::numeric_limits<double>::infinity();
}

}  // namespace clog

#include "core/scene/arrays.hpp"

#include <cmath>
#include <limits>

#include "clog/core/model/model.hpp"
#include "core/parameters/refusal.hpp"

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
  const double narrowest = model_of(run).narrowest(run);
  require(obstacles.gap > narrowest, "obstacle-gap", obstacles.gap, [&] {
    return "not wider than an edge is long, " + rounded_text(narrowest) +
           " sigma: nothing of the passage would be resolved) widen the gap or use more vertices";
  });
}

double smallest_diameter(const RunParameters& run) { return run.obstacles.smallest_diameter(); }

double endless_way(const RunParameters&) { return std::numeric_limits<double>::infinity(); }

}  // namespace clog

#include <fmt/core.h>

#include "clog/core/droplet/release.hpp"
#include "clog/core/model/model.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/units.hpp"
#include "clog/core/world/lattice.hpp"
#include "core/parameters/refusal.hpp"
#include "core/scene/arrays.hpp"

namespace clog {
namespace {

/// Replaces box and angle of a lattice by those of the nearest one that is periodic.
void find_period(RunParameters& run) {
  ObstacleParameters& obstacles = run.obstacles;
  const double angle = obstacles.lattice_angle;
  if (!obstacles.density.is_saturated() && obstacles.density != ObstacleParameters().density)
    refuse("obstacle-density", density_text(obstacles.density),
           "a lattice has one obstacle per (obstacle-gap + obstacle-diameter)^2) leave it out, or use "
           "obstacle-layout=random");
  require(obstacles.boxes == 1, "boxes", obstacles.boxes,
          "a lattice repeats in each of them) leave it out, or use obstacle-layout=random");
  require(obstacles.diameter_spread == 0, "obstacle-diameter-spread", obstacles.diameter_spread,
          "the obstacles of a lattice are alike) leave it out, or use obstacle-layout=random");
  const auto lattice = fitting_lattice(obstacles);
  if (!lattice)
    refuse("lattice-angle", angle,
           fmt::format(
               "no lattice of spacing {:.3g} within {:.3g} degrees of it has a period of box={:.3g} or less) "
               "use box={} or more",
               obstacles.diameter + obstacles.gap, largest_angle_error, obstacles.box,
               box_that_fits(obstacles)));
  obstacles.box = lattice->box;
  obstacles.lattice_angle = lattice->angle;
}

double lattice_density(const ObstacleParameters& obstacles) {
  return 1 / ((obstacles.diameter + obstacles.gap) * (obstacles.diameter + obstacles.gap));
}

ObstacleArray lattice_walls(const RunParameters& run) { return lattice_obstacles(run.obstacles, run.seed); }

/// All voids of a lattice are alike, so the seed decides where in one a droplet starts (lattice_obstacles):
/// if it touches nothing at the box's centre it starts right there, as if there were no obstacles.
DropletState release_in_lattice(const RunParameters& run, const ObstacleArray& obstacles) {
  const DropletModel& model = model_of(run);
  const double centre = obstacles.period().box / 2;
  const bool starts_free =
      clearance(obstacles, centre, centre, 2 * units::droplet_diameter) > model.reach(run);
  return starts_free ? model.release(run, ObstacleArray(obstacles.period(), {}))
                     : model.release(run, obstacles);
}

}  // namespace

const Scene lattice_scene = {.finding = Finding::clogging_length,
                             .walls_from = WallsFrom::parameters,
                             .is_random = false,
                             .gap_key = "obstacle-gap",
                             .check = check_spacing,
                             .resolve = find_period,
                             .sharpest_bend = smallest_diameter,
                             .density = lattice_density,
                             .walls = lattice_walls,
                             .release = release_in_lattice,
                             .way = endless_way};

}  // namespace clog

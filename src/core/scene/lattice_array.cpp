#include <fmt/core.h>

#include <cmath>
#include <string>

#include "clog/core/droplet/release.hpp"
#include "clog/core/model/model.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/units.hpp"
#include "clog/core/world/lattice.hpp"
#include "core/parameters/refusal.hpp"
#include "core/scene/arrays.hpp"

namespace clog {
namespace {

/// @throws Refusal of an angle that no lattice in this box has
[[noreturn]] void refuse_angle(const ObstacleParameters& obstacles) {
  Refusal::About about = {.key = "lattice-angle", .named = {"box"}};
  std::string remedy = fmt::format("use box={} or more", box_that_fits(obstacles));
  if (obstacles.length > 0) remedy += " without length";
  for (const CommensurateLattice& lattice : neighbouring_lattices(obstacles)) {
    remedy += fmt::format(", or {}", tilt_text(obstacles.lattice, lattice));
    about.nearest.push_back(lattice.angle);
  }
  throw Refusal(about, shortest(obstacles.lattice_angle),
                fmt::format("no lattice of spacing {:.3g} within {:.3g} degrees of it has a period of "
                            "box={:.3g} or less",
                            obstacles.spacing(), largest_angle_error, obstacles.box),
                remedy);
}

/// Replaces periods and angle of a lattice by those of the nearest periodic lattice.
void find_period(RunParameters& run) {
  ObstacleParameters& obstacles = run.obstacles;
  const double angle = obstacles.lattice_angle;
  if (!obstacles.density.is_saturated() && obstacles.density != ObstacleParameters().density)
    refuse("obstacle-density", density_text(obstacles.density),
           "a lattice has one that follows from its pitch) leave it out, or use obstacle-layout=random",
           {"obstacle-layout"});
  require(obstacles.boxes == 1, "boxes", obstacles.boxes,
          "a lattice repeats in each of them) leave it out, or use obstacle-layout=random",
          {"obstacle-layout"});
  require(obstacles.diameter_spread == 0, "obstacle-diameter-spread", obstacles.diameter_spread,
          "the obstacles of a lattice are alike) leave it out, or use obstacle-layout=random",
          {"obstacle-layout"});
  const double largest = largest_tilt(obstacles.lattice);
  require(std::abs(angle) <= largest + 1e-9, "lattice-angle", angle, [&] {
    return fmt::format("a {} lattice turned by {} degrees is the same) use -{}..{}", name(obstacles.lattice),
                       2 * largest, largest, largest);
  });
  const auto lattice = fitting_lattice(obstacles);
  if (!lattice) refuse_angle(obstacles);
  obstacles.box = lattice->box;
  obstacles.length = lattice->length;
  obstacles.lattice_angle = lattice->angle;
}

ObstacleArray lattice_walls(const RunParameters& run) { return lattice_obstacles(run.obstacles, run.seed); }

/// All voids of a lattice are alike, so the seed only chooses the place within a void (see
/// lattice_obstacles()). A droplet that touches nothing at the box's centre is released at the centre, in the
/// shape that it has without obstacles.
DropletState release_in_lattice(const RunParameters& run, const ObstacleArray& obstacles) {
  const DropletModel& model = model_of(run);
  const Period& period = obstacles.period();
  const bool starts_free = clearance(obstacles, period.along() / 2, period.across() / 2,
                                     2 * units::droplet_diameter) > model.reach(run);
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
                             .passing_distance = infinite_passing_distance};

}  // namespace clog

#include <fmt/core.h>

#include <algorithm>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <limits>
#include <mutex>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "clog/core/model/model.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/units.hpp"
#include "core/parameters/refusal.hpp"
#include "core/scene/arrays.hpp"

namespace clog {
namespace {

[[noreturn]] void refuse_circles(const OwnCircles& circles, const std::string& reason_and_remedy) {
  throw Error("invalid obstacles=" + circles.source() + " (" + reason_and_remedy);
}

std::string place_of(const Obstacle& circle) { return fmt::format("x={:.6g}, y={:.6g}", circle.x, circle.y); }

std::vector<Obstacle> circles_of(const ObstacleParameters& obstacles) {
  return obstacles.own->with_radii(obstacles.diameter / 2);
}

double smallest_circle(const RunParameters& run) {
  if (!run.obstacles.own || !run.obstacles.own->are_known()) return run.obstacles.diameter;
  const std::vector<Obstacle> circles = circles_of(run.obstacles);
  if (circles.empty()) return run.obstacles.diameter;
  const auto smallest =
      std::min_element(circles.begin(), circles.end(),
                       [](const Obstacle& a, const Obstacle& b) { return a.radius < b.radius; });
  return 2 * smallest->radius;
}

void check_place(const Obstacle& circle, const ObstacleParameters& obstacles) {
  const Period period = obstacles.period();
  if (2 * circle.radius >= period.box)
    refuse_circles(*obstacles.own, fmt::format("the one at {} meets its own periodic image) use a box larger "
                                               "than its diameter",
                                               place_of(circle)));
  if (!(circle.x >= 0 && circle.x < period.along() && circle.y >= 0 && circle.y < period.across()))
    refuse_circles(
        *obstacles.own,
        fmt::format("the one at {} lies outside the array) x runs from 0 to boxes*box={}, y from 0 to "
                    "box={}",
                    place_of(circle), shortest(period.along()), shortest(period.across())));
}

/// Of all circles in their period. Every task of a plan asks for it, mostly of the same circles.
ObstacleArray::Pair closest_pair(const ObstacleParameters& obstacles) {
  using Key = std::tuple<std::string, double, int, double>;
  static std::mutex mutex;
  static Key last;
  static ObstacleArray::Pair found;
  const Period period = obstacles.period();
  const Key key{obstacles.own->check_sum(), period.box, period.boxes, obstacles.diameter};
  const std::scoped_lock lock(mutex);
  if (key != last) {
    const std::vector<Obstacle> circles = circles_of(obstacles);
    for (const Obstacle& circle : circles) check_place(circle, obstacles);
    found = ObstacleArray(period, circles).closest_pair();
    last = key;
  }
  return found;
}

void check_circles(const RunParameters& run) {
  const ObstacleParameters& obstacles = run.obstacles;
  if (!obstacles.own)
    throw Error("invalid obstacle-layout=file (there are no circles) name their file: obstacles=FILE.csv");
  if (obstacles.own->circles().empty())
    refuse_circles(*obstacles.own, "there are none) lines are x,y[,diameter]");
  require(obstacles.diameter_spread == 0, "obstacle-diameter-spread", obstacles.diameter_spread,
          "circles of your own have diameters of their own) leave it out");
  const ObstacleArray::Pair pair = closest_pair(obstacles);
  const std::string both = fmt::format("those at {} and {}", place_of(pair.first), place_of(pair.second));
  if (pair.gap <= 0)
    refuse_circles(*obstacles.own,
                   fmt::format("{} touch or overlap, by {:.3g} sigma, across the border of the box too) move "
                               "them apart or make them smaller",
                               both, -pair.gap));
  const double edge = model_of(run).narrowest(run);
  if (pair.gap <= edge)
    refuse_circles(
        *obstacles.own,
        fmt::format("{} leave a gap of {:.3g} sigma, not wider than an edge, {:.3g} sigma) widen the "
                    "gap or use more vertices",
                    both, pair.gap, edge));
}

void find_gap_and_density(RunParameters& run) {
  ObstacleParameters& obstacles = run.obstacles;
  // Of few circles the gap may be wider than an array of this box can have.
  const double widest = obstacles.box / 2 - obstacles.diameter;
  obstacles.gap = std::min(closest_pair(obstacles).gap, widest);
  obstacles.density = static_cast<double>(obstacles.own->circles().size()) / obstacles.period().area();
}

/// So that the place at which the droplet is to start comes to lie in the centre.
ObstacleArray shifted_circles(const RunParameters& run) {
  const Period period = run.obstacles.period();
  std::vector<Obstacle> circles = circles_of(run.obstacles);
  if (run.obstacles.release == Release::anywhere) {
    // The constant keeps this stream apart from others.
    std::seed_seq sequence{run.seed, std::uint32_t{0x0bc1c1e5}};
    std::mt19937_64 engine(sequence);
    boost::random::uniform_01<double> uniform;
    const double x = (0.5 - uniform(engine)) * period.along();
    const double y = (0.5 - uniform(engine)) * period.across();
    for (Obstacle& circle : circles) {
      circle.x += x;
      circle.y += y;
    }
  }
  return {period, std::move(circles)};
}

double density(const ObstacleParameters& obstacles) {
  return obstacles.density.per_area.value_or(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

const Scene own_circles_scene = {.finding = Finding::clogging_length,
                                 .walls_from = WallsFrom::circles,
                                 .is_random = true,
                                 .gap_key = "obstacle-gap",
                                 .check = check_circles,
                                 .resolve = find_gap_and_density,
                                 .sharpest_bend = smallest_circle,
                                 .density = density,
                                 .walls = shifted_circles,
                                 .release = release_in_void,
                                 .way = endless_way};

}  // namespace clog

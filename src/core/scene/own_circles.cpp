#include <fmt/core.h>

#include <algorithm>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <random>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "clog/core/droplet/release.hpp"
#include "clog/core/model/model.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/units.hpp"
#include "core/parameters/refusal.hpp"
#include "core/scene/arrays.hpp"

namespace clog {
namespace {

[[noreturn]] void refuse_circles(const OwnCircles& circles, const std::string& reason_and_remedy,
                                 Named named = {}) {
  constexpr double milli = 1e-3;
  const std::string scale =
      circles.droplet()
          ? fmt::format("; 1 sigma is {:.6g} mm: are the units and the droplet of the file right?",
                        *circles.droplet() / milli)
          : "";
  refuse("obstacles", circles.source(), reason_and_remedy + scale, named);
}

/// The place of a circle, also in mm if the file of the circles gives the droplet's diameter.
std::string place_of(const Obstacle& circle, const OwnCircles& circles) {
  std::string place = fmt::format("x={:.6g}, y={:.6g}", circle.x, circle.y);
  if (!circles.droplet()) return place;
  const double millimetres = *circles.droplet() / 1e-3;
  return fmt::format("{} ({:.6g} mm, {:.6g} mm)", place, circle.x * millimetres, circle.y * millimetres);
}

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

/// The period of the array. With side walls, it includes an empty strip beside the box, which keeps the
/// droplet away from images of the circles.
Period period_of(const ObstacleParameters& obstacles) {
  Period period = obstacles.period();
  if (obstacles.side_walls == SideWalls::off) return period;
  double widest = 0;
  for (const Obstacle& circle : circles_of(obstacles)) widest = std::max(widest, 2 * circle.radius);
  period.beside = widest + 2 * units::droplet_diameter;
  return period;
}

void check_place(const Obstacle& circle, const ObstacleParameters& obstacles) {
  const Period period = period_of(obstacles);
  if (!(circle.x >= 0 && circle.x < period.along() && circle.y >= 0 && circle.y < period.box))
    refuse_circles(
        *obstacles.own,
        fmt::format(
            "the one at {} lies outside the array) x is at least 0 and less than {}={}, y than box={}; other "
            "units than droplet diameters need a first line such as # units=um droplet=200um",
            place_of(circle, *obstacles.own), obstacles.length > 0 ? "length" : "boxes*box",
            shortest(period.along()), shortest(period.box)),
        {obstacles.length > 0 ? "length" : "box", "box"});
  if (2 * circle.radius >= std::min(period.along(), period.across()))
    refuse_circles(*obstacles.own, fmt::format("the one at {} meets its own periodic image) use a box larger "
                                               "than its diameter",
                                               place_of(circle, *obstacles.own)));
}

/// The smallest gap between a wall and a post that does not touch the wall.
struct GapAtWall {
  Obstacle circle;
  double gap = std::numeric_limits<double>::infinity();  ///< [sigma]
};

GapAtWall smallest_gap_at_wall(const ObstacleArray& array, double box) {
  GapAtWall smallest;
  const std::vector<std::uint32_t> posts = array.posts();
  const std::span<const Obstacle> circles = array.obstacles();
  for (const bool is_upper : {false, true}) {
    const auto gap_of = [&](const Obstacle& circle) {
      return (is_upper ? box - circle.y : circle.y) - circle.radius;
    };
    std::vector<bool> touches(circles.size(), false);
    for (std::size_t i = 0; i < circles.size(); ++i)
      if (gap_of(circles[i]) <= 0) touches[posts[i]] = true;
    for (std::size_t i = 0; i < circles.size(); ++i)
      if (!touches[posts[i]] && gap_of(circles[i]) < smallest.gap)
        smallest = {circles[i], gap_of(circles[i])};
  }
  return smallest;
}

/// Properties of all circles of one period; cached, because most tasks of a plan have the same circles.
struct Examined {
  ObstacleArray::Pair pair;
  GapAtWall at_wall;
  std::size_t num_posts = 0;
};
Examined examined(const ObstacleParameters& obstacles) {
  using Key = std::tuple<std::string, double, double, double, double>;
  static std::mutex mutex;
  static Key last;
  static Examined found;
  const Period period = period_of(obstacles);
  const Key key{obstacles.own->check_sum(), period.box, period.along(), period.beside, obstacles.diameter};
  const std::scoped_lock lock(mutex);
  if (key != last) {
    const std::vector<Obstacle> circles = circles_of(obstacles);
    for (const Obstacle& circle : circles) check_place(circle, obstacles);
    const ObstacleArray array(period, circles);
    const std::vector<std::uint32_t> posts = array.posts();
    found = {.pair = array.closest_pair(),
             .at_wall = smallest_gap_at_wall(array, period.box),
             .num_posts = std::set(posts.begin(), posts.end()).size()};
    last = key;
  }
  return found;
}

/// Refuses gaps between a wall and a post that the mesh does not resolve. A post may overlap a wall; then
/// there is no gap.
void check_gaps_at_walls(const RunParameters& run) {
  const ObstacleParameters& obstacles = run.obstacles;
  if (obstacles.side_walls == SideWalls::off) return;
  const double edge = model_of(run).narrowest(run);
  const auto [circle, gap] = examined(obstacles).at_wall;
  if (gap <= edge)
    refuse_circles(*obstacles.own,
                   fmt::format("the one at {} leaves a gap of {:.3g} sigma at the wall, not wider than an "
                               "edge, {:.3g} sigma) let it touch the wall, or move it away",
                               place_of(circle, *obstacles.own), gap, edge));
}

/// Checks the period. Side walls separate the droplet from its images across the flow, but not from its
/// images along the flow.
void check_period(const ObstacleParameters& obstacles) {
  if (obstacles.side_walls == SideWalls::off) check_box(obstacles);
  const double length = obstacles.period().along();
  require(length >= narrowest_period, "length", length, [&] {
    return fmt::format(
        "the droplet would meet its own periodic image along the flow) use at least {}, or more boxes",
        narrowest_period);
  });
}

void check_ways(const ObstacleParameters& obstacles) {
  const double length = obstacles.period().along(), box = obstacles.box;
  require(obstacles.length == 0 || obstacles.boxes == 1, "boxes", obstacles.boxes,
          "length says how long the device is) leave one of them out");
  if (obstacles.release != Release::entrance)
    for (const auto& [key, value] :
         {std::pair("entrance", obstacles.entrance), std::pair("entrance-from", obstacles.entrance_from),
          std::pair("entrance-to", obstacles.entrance_to)})
      if (value != 0)
        throw Refusal({.key = key, .added = "release"}, shortest(value),
                      "the droplet is not released on a line", "add release=entrance, or leave this key out");
  require(obstacles.entrance < length, "entrance", obstacles.entrance,
          [&] { return fmt::format("lies outside the device) use 0 to less than {:.6g}", length); });
  const double to = obstacles.entrance_to > 0 ? obstacles.entrance_to : box;
  require(to <= box, "entrance-to", to,
          [&] { return fmt::format("is beyond the box) use at most {:.6g}", box); });
  require(obstacles.entrance_from <= to, "entrance-from", obstacles.entrance_from,
          [&] { return fmt::format("is beyond the end of the line) use at most {:.6g}", to); });
  if (obstacles.exit == 0) return;
  if (obstacles.release == Release::anywhere)
    throw Refusal({.key = "exit", .added = "release"}, shortest(obstacles.exit),
                  "droplets that are released anywhere may start behind it", "add release=entrance");
  const double start = obstacles.release == Release::entrance ? obstacles.entrance : length / 2;
  require(obstacles.exit > start, "exit", obstacles.exit,
          [&] { return fmt::format("must lie downstream of the release) use more than {:.6g}", start); });
  require(obstacles.exit <= length, "exit", obstacles.exit, [&] {
    return fmt::format("the device repeats behind its length, {:.6g}) use at most that, or a larger length",
                       length);
  });
}

std::string overlap_of(double gap) {
  constexpr double round_off = 1e-9;
  return gap > -round_off ? "touch" : fmt::format("overlap by {:.3g} sigma", -gap);
}

void check_circles(const RunParameters& run) {
  const ObstacleParameters& obstacles = run.obstacles;
  if (!obstacles.own)
    throw Refusal({.key = "obstacle-layout", .named = {"obstacles"}}, "file", "there are no circles",
                  "name their file: obstacles=FILE.csv");
  if (obstacles.own->circles().empty())
    refuse_circles(*obstacles.own, "there are none) lines are x,y[,diameter]");
  require(obstacles.diameter_spread == 0, "obstacle-diameter-spread", obstacles.diameter_spread,
          "user-supplied circles have their own diameters) leave it out");
  check_period(obstacles);
  check_ways(obstacles);
  const ObstacleArray::Pair pair = examined(obstacles).pair;
  const std::string both = fmt::format("those at {} and {}", place_of(pair.first, *obstacles.own),
                                       place_of(pair.second, *obstacles.own));
  if (pair.gap <= 0)
    refuse_circles(
        *obstacles.own,
        fmt::format("{} {}) move them apart, also from periodic images, or make them smaller; in a "
                    "post of several circles each has its centre in the next",
                    both, overlap_of(pair.gap)));
  const double edge = model_of(run).narrowest(run);
  if (pair.gap <= edge)
    refuse_circles(
        *obstacles.own,
        fmt::format("{} leave a gap of {:.3g} sigma, not wider than an edge, {:.3g} sigma) widen the "
                    "gap or use more vertices",
                    both, pair.gap, edge));
  check_gaps_at_walls(run);
}

double posts_per_area(const ObstacleParameters& obstacles) {
  return static_cast<double>(examined(obstacles).num_posts) / obstacles.period().area();
}

void find_gap_and_density(RunParameters& run) {
  ObstacleParameters& obstacles = run.obstacles;
  obstacles.gap = examined(obstacles).pair.gap;
  obstacles.density = posts_per_area(obstacles);
}

/// Two random numbers in [0, 1). The constant makes these numbers independent of other random numbers with
/// the same seed.
Eigen::Array2d drawn_from(std::uint32_t seed) {
  std::seed_seq sequence{seed, std::uint32_t{0x0bc1c1e5}};
  std::mt19937_64 engine(sequence);
  boost::random::uniform_01<double> uniform;
  const double first = uniform(engine);
  return {first, uniform(engine)};
}

/// A droplet's start on the line of the entrance, in the coordinates of the file.
Eigen::Array2d place_on_entrance(const RunParameters& run) {
  const ObstacleParameters& obstacles = run.obstacles;
  double from = obstacles.entrance_from;
  double to = obstacles.entrance_to > 0 ? obstacles.entrance_to : obstacles.box;
  if (obstacles.side_walls == SideWalls::on) {
    constexpr double film = 0.01;  // margin, so that the droplet does not touch a wall
    const double nearest = std::min(model_of(run).reach(run) + film, obstacles.box / 2);
    from = std::clamp(from, nearest, obstacles.box - nearest);
    to = std::clamp(to, nearest, obstacles.box - nearest);
  }
  return {obstacles.entrance, from + drawn_from(run.seed)[0] * (to - from)};
}

/// Converts coordinates of the file to those of the array, which has its centre at a droplet's start.
Eigen::Array2d shift_of(const RunParameters& run) {
  const Period period = period_of(run.obstacles);
  switch (run.obstacles.release) {
    case Release::centre:
      return {0, period.beside / 2};
    case Release::anywhere: {
      const Eigen::Array2d drawn = drawn_from(run.seed);
      return {(0.5 - drawn[0]) * period.along(), (0.5 - drawn[1]) * period.box + period.beside / 2};
    }
    case Release::entrance:
      return Eigen::Array2d(period.along() / 2, period.across() / 2) - place_on_entrance(run);
  }
  throw std::logic_error("a release without a place");
}

ObstacleArray shifted_device(const RunParameters& run) {
  const ObstacleParameters& obstacles = run.obstacles;
  const Eigen::Array2d shift = shift_of(run);
  std::vector<Obstacle> circles = circles_of(obstacles);
  for (Obstacle& circle : circles) {
    circle.x += shift[0];
    circle.y += shift[1];
  }
  std::vector<Wedge> walls;
  if (obstacles.side_walls == SideWalls::on)
    walls = {{.tip = shift, .axis = {0, -1}},
             {.tip = shift + Eigen::Array2d(0, obstacles.box), .axis = {0, 1}}};
  return {period_of(obstacles), std::move(circles), std::move(walls)};
}

/// Releases the droplet on the line of the entrance, in its shape without obstacles, if there is room;
/// otherwise in the nearest void.
DropletState release_in_device(const RunParameters& run, const ObstacleArray& device) {
  const Period& period = device.period();
  const Eigen::Array2d centre{period.along() / 2, period.across() / 2};
  const bool starts_free =
      run.obstacles.release == Release::entrance &&
      clearance(device, centre[0], centre[1], 2 * units::droplet_diameter) > model_of(run).reach(run) &&
      !device.is_within_post(centre);
  return release_in_void(run, starts_free ? ObstacleArray(period, {}) : device);
}

/// The periodic image of a coordinate that is in the first period.
double in_first_period(double place, double period) {
  constexpr double round_off = 1e-9;  // for a droplet that starts on the border
  if (place < 0 && place > -round_off) return 0;
  const double inside = place - period * std::floor(place / period);
  return inside < period ? inside : 0;
}

Eigen::Array2d place_in_file(const RunParameters& run, const Eigen::Array2d& place) {
  const Period period = run.obstacles.period();
  Eigen::Array2d in_file = place - shift_of(run);
  in_file[0] = in_first_period(in_file[0], period.along());
  if (run.obstacles.side_walls == SideWalls::off) in_file[1] = in_first_period(in_file[1], period.across());
  return in_file;
}

double distance_to_exit(const RunParameters& run, const Eigen::Array2d& start) {
  if (run.obstacles.exit == 0) return std::numeric_limits<double>::infinity();
  return run.obstacles.exit - start_of_path(run.obstacles, place_in_file(run, start)[0]);
}

/// The density of circles. If the parameters do not contain it, as in a stored row, it is computed from the
/// posts.
double circle_density(const ObstacleParameters& obstacles) {
  return obstacles.density.per_area ? *obstacles.density.per_area : posts_per_area(obstacles);
}

}  // namespace

double start_of_path(const ObstacleParameters& obstacles, double x) {
  if (obstacles.release != Release::entrance) return x;
  return obstacles.entrance + std::remainder(x - obstacles.entrance, obstacles.period().along());
}

bool is_displaced(const RunParameters& run, double x, double y) {
  if (run.obstacles.layout != ObstacleLayout::file || run.obstacles.release != Release::entrance)
    return false;
  constexpr double tolerated = 0.01;  // tolerance for the place of a release without obstacles nearby [sigma]
  const Eigen::Array2d drawn = place_on_entrance(run);
  const double along = start_of_path(run.obstacles, x) - drawn[0];
  const double across = std::remainder(y - drawn[1], run.obstacles.period().across());
  return std::hypot(along, across) > tolerated;
}

const Scene own_circles_scene = {.finding = Finding::clogging_length,
                                 .walls_from = WallsFrom::circles,
                                 .is_random = true,
                                 .gap_key = "obstacle-gap",
                                 .check = check_circles,
                                 .resolve = find_gap_and_density,
                                 .sharpest_bend = smallest_circle,
                                 .density = circle_density,
                                 .walls = shifted_device,
                                 .release = release_in_device,
                                 .passing_distance = distance_to_exit,
                                 .place_in_file = place_in_file};

}  // namespace clog

#include "clog/core/world/lattice.hpp"

#include <algorithm>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "clog/core/tools/portable_math.hpp"
#include "clog/core/tools/units.hpp"

namespace clog {
namespace {

constexpr double degree = std::numbers::pi / 180;
/// Angles of lattices that fit a box differ by more than this, equal ones by rounding only [degrees].
constexpr double same_angle = 1e-9;
constexpr double box_rounding = 1e-9;  // relative
/// A droplet with this much room around its centre touches nothing, polygons of 64 vertices and more
/// included.
constexpr double free_radius = 0.55 * units::droplet_diameter;

CommensurateLattice lattice(double spacing, int p, int q) {
  return {p, q, spacing * std::hypot(p, q), portable::atan2(q, p) / degree};
}

/// The one of this angle and box, if there is one: where all that is asked for fits, nothing need be looked
/// for.
std::optional<CommensurateLattice> lattice_with(double spacing, double angle, double box) {
  const auto p = std::lround(box / spacing * portable::cos(angle * degree));
  const auto q = std::lround(box / spacing * portable::sin(angle * degree));
  if (p < 1) return std::nullopt;
  const CommensurateLattice fitting = lattice(spacing, static_cast<int>(p), static_cast<int>(q));
  const bool fits =
      std::abs(fitting.box / box - 1) <= box_rounding && std::abs(fitting.angle - angle) <= same_angle;
  return fits ? std::optional(fitting) : std::nullopt;
}

/// A place in the unit cell [-1/2, 1/2]^2, in spacings: uniform where a droplet is free of the obstacle at
/// (0, 0).
struct CellPlace {
  double along, across;
};
CellPlace free_place(const ObstacleParameters& parameters, std::uint32_t seed) {
  std::seed_seq sequence{seed,
                         std::uint32_t{0x1a771ce5}};  // the constant keeps this stream apart from others
  std::mt19937_64 engine(sequence);
  boost::random::uniform_01<double> uniform;
  const double taken = (parameters.diameter / 2 + free_radius) / (parameters.diameter + parameters.gap);
  const bool has_free_places =
      taken < 0.69;  // half the cell's diagonal is 0.707: corners too small do not count
  CellPlace place{};
  do {
    place.along = uniform(engine) - 0.5;
    place.across = uniform(engine) - 0.5;
  } while (has_free_places && std::hypot(place.along, place.across) < taken);
  return place;
}

}  // namespace

std::optional<CommensurateLattice> nearest_lattice(double spacing, double angle, double smallest_box,
                                                   double largest_box) {
  if (const auto fitting = lattice_with(spacing, angle, largest_box)) return fitting;
  std::optional<CommensurateLattice> nearest;
  const double longest = largest_box * (1 + box_rounding);
  for (int p = 1; p * spacing <= longest; ++p) {
    const double wanted = p * portable::tan(angle * degree);
    for (const double q : {std::floor(wanted), std::ceil(wanted)}) {
      const CommensurateLattice candidate = lattice(spacing, p, static_cast<int>(q));
      if (candidate.box < smallest_box * (1 - box_rounding) || candidate.box > longest) continue;
      // The box grows with p: of two equally near candidates, the later is the larger.
      if (!nearest || std::abs(candidate.angle - angle) <= std::abs(nearest->angle - angle) + same_angle)
        nearest = candidate;
    }
  }
  return nearest;
}

std::optional<CommensurateLattice> nearest_lattice(const ObstacleParameters& obstacles) {
  const double spacing = obstacles.diameter + obstacles.gap;
  const double narrowest = std::max(narrowest_period, 2 * spacing);
  return nearest_lattice(spacing, obstacles.lattice_angle, narrowest, obstacles.box);
}

std::optional<CommensurateLattice> fitting_lattice(const ObstacleParameters& obstacles) {
  const auto nearest = nearest_lattice(obstacles);
  const bool is_near = nearest && std::abs(nearest->angle - obstacles.lattice_angle) <= largest_angle_error;
  return is_near ? nearest : std::nullopt;
}

double box_that_fits(const ObstacleParameters& obstacles) {
  ObstacleParameters larger = obstacles;
  std::optional<CommensurateLattice> lattice;
  while (!(lattice = fitting_lattice(larger))) larger.box += obstacles.diameter + obstacles.gap;
  return std::ceil(lattice->box);
}

ObstacleArray lattice_obstacles(const ObstacleParameters& parameters, std::uint32_t seed) {
  const double angle = parameters.lattice_angle * degree;
  const double spacing = parameters.diameter + parameters.gap;
  const long long p = std::llround(parameters.box / spacing * portable::cos(angle));
  const long long q = std::llround(parameters.box / spacing * portable::sin(angle));
  const long long num_points = p * p + q * q;
  const double length = std::sqrt(static_cast<double>(num_points));
  const double cosine = static_cast<double>(p) / length;
  const double sine = static_cast<double>(q) / length;
  const CellPlace start = free_place(parameters, seed);
  const double centre = parameters.box / 2;
  const double shift_x = centre - spacing * (start.along * cosine - start.across * sine);
  const double shift_y = centre - spacing * (start.along * sine + start.across * cosine);

  // All points have integer coordinates in units of box/num_points, so those in the box are found exactly.
  const double unit = parameters.box / static_cast<double>(num_points);
  std::vector<Obstacle> obstacles;
  obstacles.reserve(num_points);
  const long long beyond = std::abs(q);
  for (long long first = -beyond; first <= p + beyond; ++first)
    for (long long second = -beyond; second <= p + beyond; ++second) {
      const long long x = first * p - second * q;
      const long long y = first * q + second * p;
      if (x >= 0 && x < num_points && y >= 0 && y < num_points)
        obstacles.push_back({shift_x + static_cast<double>(x) * unit, shift_y + static_cast<double>(y) * unit,
                             parameters.diameter / 2});
    }
  return {parameters.box, std::move(obstacles)};
}

}  // namespace clog

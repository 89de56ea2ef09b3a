#include "clog/core/world/lattice.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/random/uniform_01.hpp>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "clog/core/tools/portable_math.hpp"
#include "clog/core/tools/units.hpp"
#include "core/parameters/refusal.hpp"

namespace clog {
namespace {

using std::numbers::sqrt3;
constexpr double degree = std::numbers::pi / 180;
/// Angles of different lattices that fit a box differ by more than this; smaller differences are rounding
/// errors [degrees].
constexpr double same_angle = 1e-9;
constexpr double box_rounding = 1e-9;  // relative
/// A droplet touches nothing if its centre is at least this far from the surface of every obstacle. This
/// holds for polygons of 64 vertices or more.
constexpr double free_radius = 0.55 * units::droplet_diameter;

/// tan t divided by q/p
double tangent_unit(LatticeKind kind) { return kind == LatticeKind::triangular ? sqrt3 : 1; }

/// Length of the shortest vector of a triangular lattice in the direction (u, sqrt(3) w), in spacings.
/// @param u,w  without a common divisor
double triangular_period(long long u, long long w) {
  assert(std::gcd(u, w) == 1);
  return std::sqrt(static_cast<double>(u * u + 3 * w * w)) / ((u - w) % 2 == 0 ? 2 : 1);
}

/// The longest allowed multiple of a period; 0 if there is none.
double multiple(double period, double longest) {
  return period * std::floor(longest * (1 + box_rounding) / period);
}

/// The lattice that has the tilt of p and q, and the largest allowed periods.
CommensurateLattice lattice(const ObstacleParameters& obstacles, int p, int q) {
  const double spacing = obstacles.spacing();
  if (obstacles.lattice == LatticeKind::square)
    return {p, q, spacing * std::hypot(p, q), 0, portable::atan2(q, p) / degree};
  const int divisor = std::gcd(p, q);
  p /= divisor;
  q /= divisor;
  double along = p, across = 1;
  if (obstacles.lattice == LatticeKind::triangular) {
    const int of_both = std::gcd(p, 3 * q);
    along = triangular_period(p, q);
    across = triangular_period(3 * q / of_both, p / of_both);
  }
  return {p, q, multiple(spacing * across, obstacles.box),
          multiple(spacing * along, obstacles.length > 0 ? obstacles.length : obstacles.box),
          portable::atan2(q * tangent_unit(obstacles.lattice), p) / degree};
}

/// The square lattice that has exactly this angle and box, if there is one; a search is then unnecessary.
std::optional<CommensurateLattice> lattice_with(const ObstacleParameters& obstacles) {
  const double steps = obstacles.box / obstacles.spacing();
  const auto p = std::lround(steps * portable::cos(obstacles.lattice_angle * degree));
  const auto q = std::lround(steps * portable::sin(obstacles.lattice_angle * degree));
  if (p < 1 || obstacles.lattice != LatticeKind::square) return std::nullopt;
  const CommensurateLattice fitting = lattice(obstacles, static_cast<int>(p), static_cast<int>(q));
  const bool fits = std::abs(fitting.box / obstacles.box - 1) <= box_rounding &&
                    std::abs(fitting.angle - obstacles.lattice_angle) <= same_angle;
  return fits ? std::optional(fitting) : std::nullopt;
}

/// For each p, calls visit(lattice) for two lattices with allowed periods: the lattice with the nearest tilt
/// below lattice_angle, and the lattice with the nearest tilt above it.
template <class Visit>
void for_each_near(const ObstacleParameters& obstacles, Visit visit) {
  const double spacing = obstacles.spacing();
  const double shortest = std::max(narrowest_period, 2 * spacing) * (1 - box_rounding);
  const double longest = obstacles.box * (1 + box_rounding);
  const bool is_square = obstacles.lattice == LatticeKind::square;
  const double step = obstacles.lattice == LatticeKind::triangular ? spacing / 2 : spacing;
  const double farthest =
      obstacles.length > 0 && !is_square ? obstacles.length * (1 + box_rounding) : longest;
  const double slope = portable::tan(obstacles.lattice_angle * degree) / tangent_unit(obstacles.lattice);
  for (int p = 1; p * step <= farthest; ++p) {
    const double wanted = p * slope;
    for (const double q : {std::floor(wanted), std::ceil(wanted)}) {
      const CommensurateLattice candidate = lattice(obstacles, p, static_cast<int>(q));
      const double length = is_square ? candidate.box : candidate.length;
      if (candidate.box >= shortest && candidate.box <= longest && length >= shortest) visit(candidate);
    }
  }
}

/// A lattice in integers, so that the points in its period are found without rounding errors. The coordinates
/// of point (i, j) are x = (x_of_i i + x_of_j j) length/end_x and y = (y_of_i i + y_of_j j) box/end_y.
struct IntegerLattice {
  long long p, q;  ///< the tangent of the tilt is q/p times tangent_unit()
  long long x_of_i, x_of_j, y_of_i, y_of_j, end_x, end_y;
  double cosine, sine;        ///< cosine and sine of the turn
  double i_x, i_y, j_x, j_y;  ///< the two vectors before the turn, in spacings
};

IntegerLattice integer_lattice(const ObstacleParameters& obstacles) {
  const double angle = obstacles.lattice_angle * degree;
  const double spacing = obstacles.spacing();
  const double along = obstacles.period().along() / spacing, across = obstacles.box / spacing;
  switch (obstacles.lattice) {
    case LatticeKind::square: {
      const long long p = std::llround(across * portable::cos(angle));
      const long long q = std::llround(across * portable::sin(angle));
      const long long end = p * p + q * q;
      const double length = std::sqrt(static_cast<double>(end));
      return {p, q, p, -q, q, p, end, end, static_cast<double>(p) / length, static_cast<double>(q) / length,
              1, 0, 0, 1};
    }
    case LatticeKind::triangular: {
      const long long p = std::llround(2 * along * portable::cos(angle));
      const long long q = std::llround(2 * along * portable::sin(angle) / sqrt3);
      const long long end = p * p + 3 * q * q;
      const double length = std::sqrt(static_cast<double>(end));
      return {p,
              q,
              2 * p,
              p - 3 * q,
              2 * q,
              p + q,
              end,
              std::llround(2 * length * across / sqrt3),
              static_cast<double>(p) / length,
              sqrt3 * static_cast<double>(q) / length,
              1,
              0,
              0.5,
              sqrt3 / 2};
    }
    case LatticeKind::rhombic:
      break;
  }
  const long long p = std::llround(along);
  const long long q = std::llround(along * portable::tan(angle));
  return {
      p, q, 1, 0, q, p, p, p * std::llround(across), 1, 0, 1, static_cast<double>(q) / static_cast<double>(p),
      0, 1};
}

/// Calls visit(x, y) for the points in a period, in units of length/end_x and box/end_y.
template <class Visit>
void for_each_point(const IntegerLattice& integers, Visit visit) {
  const auto& [p, q, x_of_i, x_of_j, y_of_i, y_of_j, end_x, end_y, cosine, sine, i_x, i_y, j_x, j_y] =
      integers;
  const long long area = x_of_i * y_of_j - x_of_j * y_of_i;
  // The corners of the period are written as multiples of the two vectors.
  const auto [first_i, last_i] =
      std::minmax({0LL, y_of_j * end_x, -x_of_j * end_y, y_of_j * end_x - x_of_j * end_y});
  const auto [first_j, last_j] =
      std::minmax({0LL, -y_of_i * end_x, x_of_i * end_y, x_of_i * end_y - y_of_i * end_x});
  for (long long i = first_i / area - 1; i <= last_i / area + 1; ++i)
    for (long long j = first_j / area - 1; j <= last_j / area + 1; ++j) {
      const long long x = x_of_i * i + x_of_j * j, y = y_of_i * i + y_of_j * j;
      if (x >= 0 && x < end_x && y >= 0 && y < end_y) visit(static_cast<double>(x), static_cast<double>(y));
    }
}

/// A random place in the unit cell around an obstacle at (0, 0), before the turn, in spacings. It is
/// uniformly distributed over the places where a droplet touches no obstacle.
struct CellPlace {
  double along, across;
};
CellPlace free_place(const ObstacleParameters& parameters, const IntegerLattice& lattice,
                     std::uint32_t seed) {
  // The constant makes these numbers independent of other random numbers with the same seed.
  std::seed_seq sequence{seed, std::uint32_t{0x1a771ce5}};
  std::mt19937_64 engine(sequence);
  boost::random::uniform_01<double> uniform;
  const double taken = (parameters.diameter / 2 + free_radius) / (parameters.diameter + parameters.gap);
  const double i_x = lattice.i_x, i_y = lattice.i_y, j_x = lattice.j_x, j_y = lattice.j_y;
  // `widest` is the distance of the middle of a void from the obstacles around it (0.707 spacings in a square
  // lattice). The factor 0.69 excludes free corners so small that a random place would almost never fall into
  // one.
  const double third = std::min(std::hypot(i_x - j_x, i_y - j_y), std::hypot(i_x + j_x, i_y + j_y));
  const double widest = std::hypot(i_x, i_y) * std::hypot(j_x, j_y) * third / (2 * (i_x * j_y - i_y * j_x));
  const bool has_free_places = taken < 0.69 * std::numbers::sqrt2 * widest;
  CellPlace place{};
  const auto is_free = [&] {
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        if (std::hypot(place.along - i * i_x - j * j_x, place.across - i * i_y - j * j_y) < taken)
          return false;
    return true;
  };
  do {
    const double i = uniform(engine) - 0.5;
    const double j = uniform(engine) - 0.5;
    place = {i * i_x + j * j_x, i * i_y + j * j_y};
  } while (has_free_places && !is_free());
  return place;
}

}  // namespace

double largest_tilt(LatticeKind kind) { return kind == LatticeKind::triangular ? 30 : 45; }

std::optional<CommensurateLattice> nearest_lattice(const ObstacleParameters& obstacles) {
  if (const auto fitting = lattice_with(obstacles)) return fitting;
  std::optional<CommensurateLattice> nearest;
  const double angle = obstacles.lattice_angle;
  // The box of square lattices grows with p. So of two equally near candidates, the later candidate has the
  // larger box.
  for_each_near(obstacles, [&](const CommensurateLattice& candidate) {
    if (!nearest || std::abs(candidate.angle - angle) <= std::abs(nearest->angle - angle) + same_angle)
      nearest = candidate;
  });
  return nearest;
}

std::optional<CommensurateLattice> fitting_lattice(const ObstacleParameters& obstacles) {
  const auto nearest = nearest_lattice(obstacles);
  const bool is_near = nearest && std::abs(nearest->angle - obstacles.lattice_angle) <= largest_angle_error;
  return is_near ? nearest : std::nullopt;
}

double box_that_fits(const ObstacleParameters& obstacles) {
  ObstacleParameters larger = obstacles;
  larger.length = 0;
  std::optional<CommensurateLattice> lattice;
  while (!(lattice = fitting_lattice(larger))) larger.box += obstacles.spacing();
  return std::ceil(std::max(lattice->box, lattice->length));
}

std::vector<CommensurateLattice> neighbouring_lattices(const ObstacleParameters& obstacles) {
  std::optional<CommensurateLattice> below, above;
  for_each_near(obstacles, [&](const CommensurateLattice& candidate) {
    if (candidate.angle <= obstacles.lattice_angle && (!below || candidate.angle > below->angle))
      below = candidate;
    if (candidate.angle >= obstacles.lattice_angle && (!above || candidate.angle < above->angle))
      above = candidate;
  });
  std::vector<CommensurateLattice> both;
  for (const auto& one : {below, above})
    if (one && std::abs(one->angle) <= largest_tilt(obstacles.lattice) + same_angle) both.push_back(*one);
  return both;
}

void use_pitch(ObstacleParameters& obstacles) {
  if (obstacles.pitch == 0) return;
  require(obstacles.pitch > obstacles.diameter, "pitch", obstacles.pitch,
          [&] {
            return fmt::format("posts of obstacle-diameter={} would touch) use more",
                               shortest(obstacles.diameter));
          },
          {"obstacle-diameter"});
  obstacles.gap = obstacles.pitch - obstacles.diameter;
  obstacles.pitch = 0;
}

double lattice_density(const ObstacleParameters& obstacles) {
  const double of_square = 1 / (obstacles.spacing() * obstacles.spacing());
  return obstacles.lattice == LatticeKind::triangular ? of_square * 2 / sqrt3 : of_square;
}

double row_spacing(const ObstacleParameters& obstacles) {
  switch (obstacles.lattice) {
    case LatticeKind::square:
      break;
    case LatticeKind::triangular:
      return obstacles.spacing() * sqrt3 / 2;
    case LatticeKind::rhombic:
      return obstacles.spacing() * portable::cos(obstacles.lattice_angle * degree);
  }
  return obstacles.spacing();
}

std::string tilt_text(LatticeKind kind, const CommensurateLattice& lattice) {
  if (lattice.q == 0) return "0 degrees";
  const int divisor = std::gcd(lattice.p, lattice.q);
  return fmt::format("{:.4g} degrees (tan = {}{}{}/{})", lattice.angle, lattice.q < 0 ? "-" : "",
                     kind == LatticeKind::triangular ? "sqrt(3)*" : "", std::abs(lattice.q) / divisor,
                     lattice.p / divisor);
}

std::string lattice_text(const ObstacleParameters& obstacles) {
  const IntegerLattice integers = integer_lattice(obstacles);
  const double length = obstacles.period().along();
  return fmt::format(
      "{} lattice: pitch {:.4g} sigma, rows {:.4g} sigma apart, at {}; period {:.4g} sigma along the flow, "
      "{:.4g} across, {:.0f} posts",
      name(obstacles.lattice), obstacles.spacing(), row_spacing(obstacles),
      tilt_text(obstacles.lattice, {.p = static_cast<int>(integers.p),
                                    .q = static_cast<int>(integers.q),
                                    .angle = obstacles.lattice_angle}),
      length, obstacles.box, lattice_density(obstacles) * length * obstacles.box);
}

ObstacleArray lattice_obstacles(const ObstacleParameters& parameters, std::uint32_t seed) {
  const double spacing = parameters.diameter + parameters.gap;
  const IntegerLattice lattice = integer_lattice(parameters);
  const CellPlace start = free_place(parameters, lattice, seed);
  const Period period = parameters.period();
  const double shift_x =
      period.along() / 2 - spacing * (start.along * lattice.cosine - start.across * lattice.sine);
  const double shift_y =
      period.box / 2 - spacing * (start.along * lattice.sine + start.across * lattice.cosine);
  const double unit_x = period.along() / static_cast<double>(lattice.end_x);
  const double unit_y = period.box / static_cast<double>(lattice.end_y);
  std::vector<Obstacle> obstacles;
  obstacles.reserve(static_cast<std::size_t>(std::lround(lattice_density(parameters) * period.area())));
  for_each_point(lattice, [&](double x, double y) {
    obstacles.push_back({shift_x + x * unit_x, shift_y + y * unit_y, parameters.diameter / 2});
  });
  return {period, std::move(obstacles)};
}

}  // namespace clog

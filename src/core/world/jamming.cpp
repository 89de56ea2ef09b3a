#include "clog/core/world/jamming.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "clog/core/tools/portable_math.hpp"

namespace clog {
namespace {

/// Two surfaces are at least the gap apart if discs of diameter + gap do not overlap. The sum diameter + gap
/// is called the spacing. All numbers below follow from the smallest and the widest spacing, and from
/// the area of the array's period.
struct Spacings {
  double smallest, widest;
  double edge;  // edge of a square with the area of the period
};

Spacings spacings_of(const ObstacleParameters& obstacles) {
  return {obstacles.smallest_diameter() + obstacles.gap, obstacles.largest_diameter() + obstacles.gap,
          std::sqrt(obstacles.period().area())};
}

/// Mean density of saturated arrays. It was measured for ratios widest/smallest from 1 to 5, in boxes of at
/// least 10 widest spacings; smaller boxes have the same density. The fit is up to 0.5 % below the
/// measurements.
double mean_density(const Spacings& spacings) {
  const double x = portable::log(spacings.widest / spacings.smallest);
  return saturated_density(spacings.smallest, 0) / (1 + x * (0.59 + x * (0.1 - x * 0.032)));
}

/// Fluctuations of the density of saturated arrays. The standard deviation of the number of obstacles is
/// proportional to the edge of a square box: it is 0.200 box/smallest for equal discs in boxes of 5 to 100
/// spacings. The factor is 0.263 at widest/smallest = 2, 0.346 at 3, and 0.43 at 5. Skewness and excess
/// kurtosis are within 0.1 of a Gaussian's. Of a million seeds (equal discs, box of 10 spacings) none is 5.5
/// deviations below the mean. So a limit eight deviations below the mean excludes none of the 2^32 seeds.
double standard_deviation(const Spacings& spacings) {
  const double of_number = 0.205 + 0.075 * (spacings.widest / spacings.smallest - 1);
  return of_number / (spacings.smallest * spacings.edge);
}

/// A lower bound of the density of saturated arrays. If not even a disc of the smallest size fits, every
/// place is within (smallest + widest)/2 of a disc's centre. So circles of this radius around the centres
/// cover the plane. Their total area is then at least 2 pi/sqrt(27) times the area of the plane (Kershner,
/// Am. J. Math. 61, 665 (1939)). The constant below is 2/sqrt(27), rounded down by more than the rounding
/// errors of coordinates.
double covering_density(const Spacings& spacings) {
  const double reach = (spacings.smallest + spacings.widest) / 2;
  return 0.3848 / (reach * reach);
}

}  // namespace

double saturated_density(double diameter, double gap) {
  constexpr double jamming_coverage = 0.547069;
  return jamming_coverage / (std::numbers::pi / 4 * (diameter + gap) * (diameter + gap));
}

std::optional<double> wanted_density(const ObstacleParameters& obstacles) {
  const ObstacleDensity& density = obstacles.density;
  return density.share ? *density.share * mean_density(spacings_of(obstacles)) : density.per_area;
}

std::optional<double> share_of_saturated(const ObstacleParameters& obstacles) {
  const std::optional<double> density = wanted_density(obstacles);
  return density ? std::optional(*density / mean_density(spacings_of(obstacles))) : std::nullopt;
}

double largest_density(const ObstacleParameters& obstacles) {
  const Spacings spacings = spacings_of(obstacles);
  return std::max(covering_density(spacings), mean_density(spacings) - 8 * standard_deviation(spacings));
}

}  // namespace clog

#include "clog/fit/migration.hpp"

#include <cmath>
#include <limits>

namespace clog::fit {

Migration fit_migration(std::span<const Displacement> runs) {
  constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
  double along = 0;
  double across = 0;
  double n = 0;
  const auto is_counted = [](const Displacement& run) { return run.along >= shortest_migration; };
  for (const Displacement& run : runs) {
    if (!is_counted(run)) continue;
    ++n;
    along += run.along;
    across += run.across;
  }
  if (!(along > 0) || std::isinf(along)) return {undefined, undefined};
  const double slope = across / along;
  if (n < 2) return {slope, undefined};
  double scatter = 0;
  for (const Displacement& run : runs)
    if (is_counted(run)) scatter += std::pow(run.across - slope * run.along, 2);
  return {slope, std::sqrt(scatter * n / (n - 1)) / along};
}

}  // namespace clog::fit

#include "clog/fit/migration.hpp"

#include <cmath>
#include <limits>

namespace clog::fit {

Migration fit_migration(std::span<const Displacement> runs) {
  constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
  double along = 0;
  double across = 0;
  for (const Displacement& run : runs) {
    along += run.along;
    across += run.across;
  }
  if (!(along > 0) || std::isinf(along)) return {undefined, undefined};
  const double slope = across / along;
  if (runs.size() < 2) return {slope, undefined};
  double scatter = 0;
  for (const Displacement& run : runs) scatter += std::pow(run.across - slope * run.along, 2);
  const auto n = static_cast<double>(runs.size());
  return {slope, std::sqrt(scatter * n / (n - 1)) / along};
}

}  // namespace clog::fit

#include "clog/core/world/bare_stretch.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

namespace clog {
namespace {

double width(const Stretch& stretch) { return stretch.end - stretch.begin; }

constexpr double droplet = 1;  // diameter [sigma]

/// Gaps between the projections of circles onto an axis, the widest first. A gap may extend across the border
/// of the period.
std::vector<Stretch> bare_stretches(std::span<const Obstacle> circles, double Obstacle::*centre,
                                    double period) {
  assert(!circles.empty());
  std::vector<Stretch> shadows;
  for (const Obstacle& circle : circles)
    shadows.push_back({circle.*centre - circle.radius, circle.*centre + circle.radius});
  std::sort(shadows.begin(), shadows.end(),
            [](const Stretch& a, const Stretch& b) { return a.begin < b.begin; });
  // A projection that extends across the end of the period may cover the beginning of the period.
  double covered = shadows.front().begin;
  for (const Stretch& shadow : shadows) covered = std::max(covered, shadow.end - period);
  std::vector<Stretch> bare;
  for (const Stretch& shadow : shadows) {
    if (shadow.begin > covered) bare.push_back({covered, shadow.begin});
    covered = std::max(covered, shadow.end);
  }
  if (const double again = shadows.front().begin + period; again > covered) bare.push_back({covered, again});
  std::stable_sort(bare.begin(), bare.end(),
                   [](const Stretch& a, const Stretch& b) { return width(a) > width(b); });
  return bare;
}

}  // namespace

std::optional<Stretch> conspicuous_bare_stretch(std::span<const Obstacle> circles, double Obstacle::*centre,
                                                double period) {
  if (circles.size() < 2) return {};
  const std::vector<Stretch> stretches = bare_stretches(circles, centre, period);
  if (stretches.empty()) return {};
  const double next = stretches.size() > 1 ? width(stretches[1]) : 0;
  if (width(stretches.front()) <= 2 * next + droplet) return {};
  return stretches.front();
}

std::vector<Stretch> bare_lanes(std::span<const Obstacle> circles, double period) {
  if (circles.empty()) return {};
  std::vector<Stretch> lanes = bare_stretches(circles, &Obstacle::y, period);
  std::erase_if(lanes, [](const Stretch& lane) { return width(lane) <= droplet; });
  return lanes;
}

}  // namespace clog

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "clog/core/parameters/circles.hpp"

namespace clog {

/// Part of a period that no circle covers [sigma].
struct Stretch {
  double begin = 0;  ///< within the period
  double end = 0;    ///< larger than the period if the stretch continues across the period's border
};

/// The widest bare stretch of an array along an axis, if it suggests a mistake in the array's length. This is
/// the case if the stretch is wider than a droplet plus twice the second widest stretch. Otherwise nullopt.
/// Also nullopt for a single circle, which may be the unit cell of an array.
/// @param centre  the coordinate along the axis: &Obstacle::x or &Obstacle::y
/// @param period  period of the array along the axis [sigma]; no circle is wider
std::optional<Stretch> conspicuous_bare_stretch(std::span<const Obstacle> circles, double Obstacle::*centre,
                                                double period);

/// Bare stretches across the flow, the widest first. They are wider than a droplet, so droplets sink through
/// them without a contact. Empty for a period without circles.
/// @param period  of the array across the flow [sigma]
std::vector<Stretch> bare_lanes(std::span<const Obstacle> circles, double period);

}  // namespace clog

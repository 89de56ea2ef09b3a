#pragma once

#include <optional>
#include <span>
#include <vector>

#include "clog/core/parameters/circles.hpp"

namespace clog {

/// Part of a period over which no circle reaches [sigma].
struct Stretch {
  double begin = 0;  ///< within the period
  double end = 0;    ///< beyond the period if the stretch goes over its border
};

/// The widest bare stretch of an array along one of its axes, if it is so wide against all others that the
/// array was probably meant to be shorter: wider than a droplet, and than twice the next one and a droplet.
/// A single circle is an array of its own and has none.
/// @param centre  of a circle along the axis: &Obstacle::x or &Obstacle::y
/// @param period  of the array along it [sigma]; no circle is wider
std::optional<Stretch> conspicuous_bare_stretch(std::span<const Obstacle> circles, double Obstacle::*centre,
                                                double period);

/// Bare stretches across the flow that are wider than a droplet, the widest first: droplets sink through them
/// and touch nothing. A period without circles has none.
/// @param period  of the array across the flow [sigma]
std::vector<Stretch> bare_lanes(std::span<const Obstacle> circles, double period);

}  // namespace clog

#pragma once

#include <optional>

#include "clog/core/parameters/parameters.hpp"

namespace clog {

/// Density of a saturated array of equal discs [1/sigma^2]: discs of diameter + gap cover 0.547069 of the
/// plane at the jamming limit of random sequential addition (Feder 1980; value of Wang, Int. J. Mod. Phys. C
/// 5, 707 (1994)).
double saturated_density(double diameter, double gap);

/// The density that a random array should have [1/sigma^2]; nullopt if as many obstacles as possible are
/// requested. A share is relative to the mean density of saturated arrays of these diameters and this gap,
/// for any box.
std::optional<double> wanted_density(const ObstacleParameters& obstacles);

/// The density of a random array as a share of the mean density of saturated arrays of these diameters and
/// this gap. nullopt if as many obstacles as possible are requested.
std::optional<double> share_of_saturated(const ObstacleParameters& obstacles);

/// The largest density of a random array that every seed can reach [1/sigma^2]. It is eight standard
/// deviations below the mean of saturated arrays of this box. In small boxes, where this value would be
/// almost zero, the result is the smallest possible density of a saturated array.
/// @param obstacles  of random layout
double largest_density(const ObstacleParameters& obstacles);

}  // namespace clog

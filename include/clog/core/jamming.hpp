#pragma once

namespace clog {

/// Density of a saturated array of equal discs [1/sigma^2]: discs of diameter + gap cover 0.547069 of the
/// plane at the jamming limit of random sequential addition (Feder 1980; value of Wang, Int. J. Mod. Phys. C
/// 5, 707 (1994)).
double saturated_density(double diameter, double gap);

}  // namespace clog

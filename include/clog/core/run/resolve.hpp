#pragma once

#include "clog/core/parameters/parameters.hpp"

namespace clog {

/// Replaces every `auto` (empty optional), and box and angle of a lattice, by the value that will be used,
/// then validates.
/// @throws Error naming the field, its value, the reason and a remedy
RunParameters resolve(RunParameters run);

/// The published range of contact [sigma].
double half_vertex_diameter(const DpParameters& dp);

/// K_l where none is given [g rho sigma]: a fraction of Gamma for springs to the rest length; 1 for those to
/// the mean length; 0.003/V_t for those along the interface, which even out vertices at a rate of (2 pi)^2
/// K_l V_t/M = 0.15/t0. Stiffer ones have been seen to flutter where the drag is weak, as they have no
/// energy.
double automatic_perimeter_stiffness(const RunParameters& run);

/// Greatest pressure difference over the interface of a droplet held by obstacles that can be expected [g rho
/// sigma]: that of its own curvature, of a bend around the smallest obstacle, and of a column of liquid one
/// diameter tall.
double expected_pressure(const RunParameters& run);

/// K_a where none is given [g rho / sigma]: the expected pressure changes the area by two thousandths, but at
/// most the published 1e4, which soft droplets do not need and which would cost them steps.
double automatic_area_stiffness(const RunParameters& run);

/// Time step where none is given [t0], K_a and K_l are. It resolves the drag's relaxation time ten times. For
/// a polygon every stiff mode of a circle stays within auto_step_margin of its bound (stability.hpp), and an
/// automatic contact, whose stiffness goes with the step, is so stiff that the expected pressure pushes an
/// obstacle into the interface by a fiftieth of a vertex diameter; for a soft disk the step resolves its
/// contact's period sixty times. Rounded down to two digits.
double automatic_time_step(const RunParameters& run);

}  // namespace clog

#pragma once

#include "clog/core/parameters/parameters.hpp"

namespace clog {

/// Gamma above which a droplet sags by less than a hundredth of its diameter under its weight: a larger Gamma
/// moves clogs by some hundredths of a diameter, and costs more.
inline constexpr double nearly_rigid_tension = 30;

/// The automatic N_v. The corners of a polygon that hangs over an obstacle can hold up to x^2/16 of the
/// weight: x = l/R', where l is the length of the edges on the obstacle, and R' the radius at which they lie.
/// N_v limits this to half a percent for the longest expected edges, and is between 128 and 1024.
/// @param obstacle_diameter  of the smallest obstacle over which the droplet can hang, infinite if there is
/// none [sigma]
int automatic_vertices(const RunParameters& run, double obstacle_diameter);

/// Half a vertex diameter, the published range of contact [sigma].
double half_vertex_diameter(const DpParameters& dp);

/// The automatic K_l [g rho sigma]: a fraction of Gamma for springs to the rest length; 1 for those to the
/// mean length; 0.003/V_t for those along the interface, which even out vertices at a rate of (2 pi)^2 K_l
/// V_t/M = 0.15/t0. Stiffer springs along the interface fluttered at weak drag, because their force derives
/// from no potential energy.
double automatic_perimeter_stiffness(const RunParameters& run);

/// Largest expected pressure difference across the interface of a droplet held by obstacles [g rho sigma]:
/// the sum of the pressures of its own curvature, of the sharpest bend (see Scene), and of a column of liquid
/// one diameter tall.
double expected_pressure(const RunParameters& run, double sharpest_bend);

/// The automatic K_a [g rho / sigma], with which the expected pressure changes the area by two thousandths;
/// at most the published 1e4. Soft droplets need less than that, and a larger K_a requires more steps.
double automatic_area_stiffness(const RunParameters& run, double sharpest_bend);

/// DropletModel::resolve of the polygon. The automatic step is at most drag_time_step(). Every stiff mode of
/// a circle stays within auto_step_margin of its bound (stability.hpp), and the expected pressure presses an
/// obstacle into an automatic contact, whose stiffness depends on the step, by a fiftieth of a vertex
/// diameter. The step is rounded down to two digits.
void resolve_polygon(RunParameters& run, double sharpest_bend);

}  // namespace clog

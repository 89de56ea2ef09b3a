#pragma once

#include "clog/core/parameters/parameters.hpp"

namespace clog {

/// Gamma above which a droplet sags by less than a hundredth of its diameter under its weight. With a larger
/// Gamma, the places of clogs shift by only some hundredths of a diameter, and runs take more time.
inline constexpr double nearly_rigid_tension = 30;

/// The automatic N_v. The corners of a polygon that hangs over an obstacle can hold up to x^2/16 of the
/// weight. Here x is the length of the edges on the obstacle divided by their distance from the obstacle's
/// centre. N_v limits this fraction to half a percent for the longest expected edges, and is between 128 and
/// 1024.
/// @param obstacle_diameter  diameter of the smallest obstacle over which the droplet can hang; infinite if
/// there is none [sigma]
int automatic_vertices(const RunParameters& run, double obstacle_diameter);

/// Half a vertex diameter, the published range of contact [sigma].
double half_vertex_diameter(const DpParameters& dp);

/// The automatic K_l [g rho sigma]. For springs to the rest length it is a fraction of Gamma; for springs to
/// the mean length it is 1; for springs along the interface it is 0.003/V_t. Springs along the interface even
/// out the spacing of the vertices at a rate of (2 pi)^2 K_l V_t/M = 0.15/t0. Stiffer springs along the
/// interface fluttered at weak drag, because their force derives from no potential energy.
double automatic_perimeter_stiffness(const RunParameters& run);

/// Largest expected pressure difference across the interface of a droplet held by obstacles [g rho sigma]. It
/// is the sum of three pressures: the pressure of the droplet's own curvature, the pressure of the sharpest
/// bend (see Scene), and the pressure of a column of liquid one diameter tall.
double expected_pressure(const RunParameters& run, double sharpest_bend);

/// The automatic K_a [g rho / sigma], with which the expected pressure changes the area by two thousandths.
/// It is at most the published 1e4: soft droplets need less, and a larger K_a requires shorter steps.
double automatic_area_stiffness(const RunParameters& run, double sharpest_bend);

/// Implements DropletModel::resolve for the polygon. The automatic step is at most drag_time_step(), and is
/// rounded down to two digits. With this step, every stiff mode of a circle stays within auto_step_margin of
/// its bound (stability.hpp). The step also determines the automatic contact stiffness. The step is so short,
/// and the contact therefore so stiff, that the expected pressure presses an obstacle into the contact range
/// by at most a fiftieth of a vertex diameter.
void resolve_polygon(RunParameters& run, double sharpest_bend);

}  // namespace clog

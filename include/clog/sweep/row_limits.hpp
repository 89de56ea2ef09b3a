#pragma once

#include <string>
#include <vector>

#include "clog/sweep/plan.hpp"
#include "clog/sweep/run_row.hpp"

namespace clog::sweep {

/// The parameters of a run that are outside the tested range, each with its value and the range:
/// "line-tension=30 (robust is tested from 0.02 to 10)".
std::vector<std::string> untested_parameters(const RunRow& row);
/// One line about all runs of a plan; empty if all are within the tested range.
std::string untested_parameters(const Plan& plan);

/// Distance after which a droplet may meet the same obstacles again [sigma]. It is the period along the flow;
/// the period across the flow has no effect. It is infinite without an array, in an array with an exit, and
/// for lattices, because a real lattice repeats, too.
double repetition_length(const RunRow& row);
/// Whether the droplet has come as far as repetition_length().
bool has_met_repetition(const RunRow& row);
/// A warning of one line if runs of a plan may reach their repetition_length(); empty otherwise.
std::string possible_repetition(const Plan& plan);

/// Lines about files of circles in which a conspicuous part of the array is bare, or circles have no
/// diameter.
std::vector<std::string> limits_of_circles(const Plan& plan);

/// Known limitations of a plan's results: all lines that the functions above return.
std::vector<std::string> limits_of_results(const Plan& plan);

/// Largest share of the droplet's weight that the polygon's corners may carry; beyond it, a clog is
/// attributed to the corners, not to the obstacles.
inline constexpr double tolerated_mesh_hold = 0.01;
/// Largest difference between the weights of the two lobes of a wrapped droplet that friction can hold, as a
/// share of the droplet's weight. A wrapped droplet hangs over a round obstacle with a lobe on each side. On
/// half of the obstacle's circumference, two parts of the droplet's interface are one above the other, with a
/// film between them. So the tensions on the two sides have a ratio of at most exp(pi mu), as with a capstan.
/// The result is zero unless friction acts on both parts of the interface (film-friction=on).
double weight_borne_by_friction(const DpParameters& dp);
/// Whether the corners of the polygon may hold this clog. This is the case if the corners can bear more of
/// the weight than friction. If mesh_hold is unknown, or if friction acts only on the interface next to the
/// wall, the result is true for every droplet that hangs over obstacles (docs/explanation/wrapped.md).
bool may_hang_on_mesh(const RunRow& row);
/// Largest friction_use with which a clog certainly holds on finer meshes, too. Meshes of 256 to 1024
/// vertices agree within 5 % on the largest distance from a post's axis at which friction holds a droplet
/// (docs/notes/2026-11-28-layers.md). Beyond this friction_use, a finer mesh may let the droplet go.
inline constexpr double tolerated_friction_use = 0.95;
/// A droplet with at least this friction_use has slid around a post until friction held it. So the driving
/// force decreases in the direction of sliding, and on other meshes the droplet would stop at a nearby place.
inline constexpr double arrested_friction_use = 0.999;
/// Whether nearly all available friction is needed to hold the droplet, although the droplet did not slide
/// into this position.
bool is_near_friction_limit(const RunRow& row);

/// Smallest possible distance between the centres of two obstacles, or the mean of this distance if diameters
/// vary [sigma]. For user-supplied circles the spacing is 1/sqrt(circles per area), because their diameters
/// may vary, and one gap may be narrower than all others. The release void is about as large as the spacing.
double obstacle_spacing(const RunRow& row);

}  // namespace clog::sweep

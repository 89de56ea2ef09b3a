#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace clog::fit {

/// A droplet on its way through a narrow channel, seen in one frame.
struct Frame {
  double h;      ///< of the centre of mass from the orifice, positive downstream [sigma]
  double speed;  ///< along the flow [v_t]
  double shape;  ///< A = perimeter^2/(4 pi area); NaN if it is not known
};
using Profile = std::vector<Frame>;

/// The first frame at h, interpolated linearly; nothing if the droplet does not come there.
/// @param profile  in the order of time
std::optional<Frame> frame_at(const Profile& profile, double h);

/// Root-mean-square relative deviations of a measured profile from a simulated one (Cheng et al., Delta_v and
/// Delta_A), the simulation interpolated linearly to each frame's h. A frame at an h that the simulated
/// droplet never came to counts as a deviation of 10, of speed as 10 more for each diameter that is missing.
/// Delta_A is NaN without shapes.
struct Deviation {
  double speed;
  double shape;
};
/// @param simulated  in the order of time; of several passages at one h the first counts
/// @throws std::invalid_argument if there is no measured frame
Deviation deviation(const Profile& measured, const Profile& simulated);

/// Correlation of the residuals of successive frames, in the order of h: near zero, within 1/sqrt(frames),
/// for independent noise; near one where the simulated profile has another shape. NaN for fewer than eight
/// frames, and without shapes.
Deviation residual_correlation(const Profile& measured, const Profile& simulated);

/// The line tension and the near-wall drag that a profile speaks for.
struct Calibration {
  double line_tension = 0;          ///< Gamma* [g rho sigma^2]
  double near_wall_drag = 0;        ///< b_0*/b_inf
  double line_tension_error = 0;    ///< from the scatter of this profile's frames about the best run
  double near_wall_drag_error = 0;  ///< likewise; both NaN if the profile does not determine both
  Deviation deviation{};            ///< of the best run
  Deviation correlation{};          ///< of its residuals, see residual_correlation()
  int num_frames = 0;
  int num_simulations = 0;
  bool is_converged = false;  ///< a new search from the best found nothing better
  bool is_at_bound = false;   ///< of the range: the best may lie beyond
  int num_never_reached = 0;  ///< frames at an h that the best run's droplet did not come to
  double clogging_tension =
      0;  ///< Gamma from which on droplets do not come to all frames; NaN if all do, or none
};
/// The range in which the minimum of Delta_v is sought.
struct CalibrationRange {
  double least_tension = 0.02;
  double most_tension = 10;
  double most_drag = 2;
};
/// Simulated profile for a line tension and b_0/b_inf. Called from several threads at a time.
using Simulation = std::function<Profile(double line_tension, double near_wall_drag)>;
/// The result of a simulation.
struct CalibrationAttempt {
  double line_tension = 0;
  double near_wall_drag = 0;
  double delta = 0;  ///< Delta_v
};
/// Told of every simulation, from several threads at a time.
using CalibrationProgress = std::function<void(const CalibrationAttempt& attempt)>;

/// Whether calibrate() is in this build: it needs NLopt.
bool can_calibrate();

/// Minimises Delta_v. Near a line tension at which the droplet clogs it has several minima, narrow ones. So
/// the search begins from the best points of a coarse grid, logarithmic in Gamma; brackets the line tension
/// at which the droplet clogs, if it does; begins again at distances from there that double; and restarts
/// from the best of all until that helps no more. Each is Nelder and Mead's simplex. It takes a few hundred
/// simulations and is the same every time.
///
/// Errors are those of linearised least squares with independent frames of equal relative scatter, linearised
/// over a range like the errors themselves.
/// @throws std::invalid_argument for fewer than three frames; what a simulation throws, which ends the
/// search;
///         std::logic_error without can_calibrate()
Calibration calibrate(const Profile& measured, const Simulation& simulate, const CalibrationRange& range = {},
                      const CalibrationProgress& progress = {});

/// Mean and standard deviation over independent trials, as published (Cheng et al., Fig. 2).
struct Trials {
  double line_tension, line_tension_deviation;
  double near_wall_drag, near_wall_drag_deviation;  ///< deviations are NaN for one trial
};
Trials combine(std::span<const Calibration> trials);

}  // namespace clog::fit

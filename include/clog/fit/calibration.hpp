#pragma once

#include <functional>
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

/// Root-mean-square relative deviations of a measured profile from a simulated one (Cheng et al., Delta_v and
/// Delta_A), the simulation interpolated linearly to each frame's h. A frame at an h that the simulated
/// droplet never came to counts as a deviation of 10. Delta_A is NaN without shapes.
struct Deviation {
  double speed;
  double shape;
};
/// @param simulated  in the order of time; of several passages at one h the first counts
/// @throws std::invalid_argument if there is no measured frame
Deviation deviation(const Profile& measured, const Profile& simulated);

/// The line tension and the near-wall drag that a profile speaks for.
struct Calibration {
  double line_tension = 0;          ///< Gamma* [g rho sigma^2]
  double near_wall_drag = 0;        ///< b_0*/b_inf
  double line_tension_error = 0;    ///< from the scatter of this profile's frames about the best run
  double near_wall_drag_error = 0;  ///< likewise; both NaN if the profile does not determine both
  Deviation deviation{};            ///< of the best run
  int num_simulations = 0;
  bool is_at_bound = false;   ///< of the range: the best may lie beyond
  int num_never_reached = 0;  ///< frames at an h that the best run's droplet did not come to
};
/// Where Delta_v is sought.
struct CalibrationRange {
  double least_tension = 0.02;
  double most_tension = 10;
  double most_drag = 2;
};
/// Simulated profile for a line tension and b_0/b_inf.
using Simulation = std::function<Profile(double line_tension, double near_wall_drag)>;

/// Minimises Delta_v: a coarse grid, logarithmic in Gamma, then Nelder and Mead's simplex from its best
/// point. Errors are those of linearised least squares with independent frames of equal relative scatter.
/// @throws std::invalid_argument for fewer than three frames
Calibration calibrate(const Profile& measured, const Simulation& simulate,
                      const CalibrationRange& range = {});

/// Mean and standard deviation over independent trials, as published (Cheng et al., Fig. 2).
struct Trials {
  double line_tension, line_tension_deviation;
  double near_wall_drag, near_wall_drag_deviation;  ///< deviations are NaN for one trial
};
Trials combine(std::span<const Calibration> trials);

}  // namespace clog::fit

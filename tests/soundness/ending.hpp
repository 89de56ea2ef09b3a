#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "clog/core/droplet/droplet_state.hpp"

namespace clog::soundness {

/// What a droplet that has not clogged does at the end of its run.
enum class Ending {
  moving,      ///< travels: the mean speed of its centre is above `slowest_travel` V_t
  decaying,    ///< has stopped, and its kinetic energy is falling
  steady,      ///< has stopped, but its interface creeps on
  chattering,  ///< has stopped, but its vertices shake about their places
};
const char* name(Ending ending);

/// Judges the end of a run from measurements over a window of time. The ending is the first of these whose
/// condition holds:
///   moving      mean_speed > slowest_travel
///   decaying    fall > least_fall, and the last quarter of the window is not above the third
///   chattering  coherence < least_coherence: vertices come much less far than at their speed they could
///   steady      none of the above
struct Tail {
  double mean_speed = 0;  ///< distance of the centre's last place from its first, divided by the time [V_t]
  double level = 0;       ///< median of log10(E_k/E_t) in the last quarter
  double fall = 0;        ///< fall of the median of log10(E_k/E_t) from the first quarter to the last
  double last_fall = 0;   ///< the same from the third quarter to the last
  double band = 0;        ///< log10(E_k/E_t) in the last quarter, 95 % quantile minus 5 % quantile
  /// Path of the vertices between two samples, divided by the path that follows from E_k.
  double coherence = 0;

  Ending ending() const;
};

inline constexpr double slowest_travel = 0.01;
inline constexpr double least_fall = 0.1;
inline constexpr double least_coherence = 0.3;

/// Collects the samples from which a Tail is computed, near the end of a run.
class TailRecorder {
 public:
  explicit TailRecorder(double terminal_speed) : terminal_speed_(terminal_speed) {}

  /// Call this at even intervals, each of length `interval` [t0].
  void add_energy(double energy_ratio, double interval);
  /// Call this once before add_energy(), then more seldom, at intervals of many relaxation times V_t/g.
  void add_place(const DropletState& state);
  /// Empty if there were too few samples.
  std::optional<Tail> tail() const;

 private:
  double terminal_speed_;
  std::vector<double> log_energy_;
  double time_ = 0;
  double expected_way_ = 0;      // since the last place [sigma]
  double sum_expected_way_ = 0;  // until the last place [sigma]
  double sum_way_ = 0;           // root mean square over the vertices, between places [sigma]
  std::optional<DropletState> first_, last_;
};

}  // namespace clog::soundness

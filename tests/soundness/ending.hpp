#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "clog/core/droplet/droplet_state.hpp"

namespace clog::soundness {

/// The behaviour of a droplet that has not clogged, at the end of its run.
enum class Ending {
  moving,      ///< The droplet travels: the mean speed of its centre is above `slowest_travel` V_t.
  decaying,    ///< The droplet has stopped, and its kinetic energy is falling.
  steady,      ///< The droplet has stopped, but its interface creeps on.
  chattering,  ///< The droplet has stopped, but its vertices shake about their places.
};
const char* name(Ending ending);

/// Judges the end of a run from measurements over a window of time. The ending is the first in this list
/// whose condition is fulfilled:
///   moving      mean_speed > slowest_travel
///   decaying    fall > least_fall, and the last quarter of the window is not above the third
///   chattering  coherence < least_coherence: vertices move a much shorter distance than their speed permits
///   steady      none of the above
struct Tail {
  double mean_speed = 0;  ///< Distance between the centre's first and last places, divided by the time [V_t].
  double level = 0;       ///< Median of log10(E_k/E_t) in the last quarter.
  double fall = 0;        ///< Fall of the median of log10(E_k/E_t) from the first quarter to the last.
  double last_fall = 0;   ///< Fall of this median from the third quarter to the last.
  double band = 0;        ///< Width of log10(E_k/E_t) in the last quarter: 95 % minus 5 % quantile.
  /// How far vertices get between two places, divided by the length of their path, which follows from E_k.
  double coherence = 0;

  Ending ending() const;
};

inline constexpr double slowest_travel = 0.01;
inline constexpr double least_fall = 0.1;
inline constexpr double least_coherence = 0.3;

/// Collects samples near the end of a run, from which a Tail is computed.
class TailRecorder {
 public:
  explicit TailRecorder(double terminal_speed) : terminal_speed_(terminal_speed) {}

  /// Adds E_k/E_t. Call this at equal intervals. @param interval  time between two calls [t0]
  void add_energy(double energy_ratio, double interval);
  /// Adds the positions of the vertices. Call this before the first add_energy(), and then at intervals of
  /// many relaxation times V_t/g.
  void add_place(const DropletState& state);
  /// The tail, or nothing if there were too few samples.
  std::optional<Tail> tail() const;

 private:
  double terminal_speed_;
  std::vector<double> log_energy_;
  double time_ = 0;
  double expected_way_ = 0;      // Length of path that follows from E_k, since the last place [sigma].
  double sum_expected_way_ = 0;  // The same length up to the last place [sigma].
  // Root mean square displacement of the vertices between two places, summed over all places [sigma].
  double sum_way_ = 0;
  std::optional<DropletState> first_, last_;
};

}  // namespace clog::soundness

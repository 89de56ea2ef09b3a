#pragma once

#include <limits>

#include "clog/core/tools/byte_archive.hpp"

namespace clog {

/// Distance and time of a run after a fixed starting time; NaN for a run that ended before this time.
struct SteadyTravel {
  double distance = std::numeric_limits<double>::quiet_NaN();  ///< along the flow [sigma]
  double time = std::numeric_limits<double>::quiet_NaN();      ///< [t0]
};

/// Stores the displacement at a fixed time. The steady speed of a run counts from this time on. The time is
/// known before the run and is the same for all droplets of one terminal speed, so it does not favour fast
/// droplets.
class SteadyRecord {
 public:
  /// Distance that a droplet sinks without obstacles until the time at which the steady speed begins [sigma].
  /// A droplet is released in a void, where it is fast. The speed of stiff disks is within 0.4 % of its limit
  /// after 3 sigma (docs/notes/2026-11-28-steady-speed.md).
  static constexpr double free_fall = 5;

  /// @param terminal_speed  [sqrt(sigma g)]
  explicit SteadyRecord(double terminal_speed) : start_(free_fall / terminal_speed) {}

  /// Call this once per check of a run. @param displacement  along the flow since release [sigma]
  void add(double time, double displacement);

  /// The travel from the time at which the steady speed begins to a later time. @param displacement  at that
  /// time
  SteadyTravel until(double time, double displacement) const;

  void save(ByteWriter& bytes) const { bytes.put(begin_); }
  void restore(ByteReader& bytes) { bytes.get(begin_); }

 private:
  double start_;        // [t0]
  SteadyTravel begin_;  // displacement and time at the first check after start_
};

}  // namespace clog

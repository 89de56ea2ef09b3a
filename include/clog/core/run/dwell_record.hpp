#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "clog/core/tools/byte_archive.hpp"

namespace clog {

/// A time in which the droplet advanced by at most dwell-length; NaN if there is none.
struct Dwell {
  double length = std::numeric_limits<double>::quiet_NaN();  ///< duration [t0]
  /// Distance along the flow at which the dwell began [sigma].
  double distance = std::numeric_limits<double>::quiet_NaN();
  double begin = std::numeric_limits<double>::quiet_NaN();  ///< time at which the dwell began [t0]
};

/// The dwells of a run that were longer than all dwells before them.
struct Dwells {
  static constexpr std::size_t most = 8;

  /// The longest dwell of the run, then the longest of the dwells before it, and so on. If there are more
  /// than `most`, the earliest are dropped.
  std::array<Dwell, most> longest;
  /// Smallest time for which first_longer() may be called [t0]; NaN if the dwells are unknown.
  double known_from = std::numeric_limits<double>::quiet_NaN();
  /// Distance [sigma] and time [t0] at which the last dwell began.
  double last_distance = std::numeric_limits<double>::quiet_NaN();
  double last_begin = std::numeric_limits<double>::quiet_NaN();

  /// The first dwell longer than `time`; nullptr if there was none.
  /// @param time  not less than known_from [t0]
  const Dwell* first_longer(double time) const;
  /// @param dwell  must be later than all dwells kept so far
  void keep(const Dwell& dwell);
};

/// Follows a droplet's distance, and finds its dwells. The first dwell begins at the release. A dwell ends,
/// and the next begins, when the droplet is farther than dwell-length from the place where the dwell began.
class DwellRecord {
 public:
  /// Dwells are recorded only if they are longer than this many times dwell_length/terminal_speed, the time
  /// in which a free droplet advances by dwell_length.
  static constexpr double shortest = 10;

  /// @param dwell_length  [sigma]; @param terminal_speed  [sqrt(sigma g)]
  DwellRecord(double dwell_length, double terminal_speed);

  /// Call this once per check of a run. @param displacement  along the flow since release [sigma]
  void add(double time, double displacement);

  /// @param time  time of the last check [t0]. The unfinished dwell counts with its length so far, except in
  /// a clogged run.
  Dwells found(double time, bool has_clogged) const;

  void save(ByteWriter& bytes) const { bytes.put(found_); }
  void restore(ByteReader& bytes) { bytes.get(found_); }

 private:
  double dwell_length_;
  Dwells found_;  // the dwells that have ended

  Dwell present(double time) const;
};

}  // namespace clog

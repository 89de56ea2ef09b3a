#pragma once

#include <cstdint>
#include <vector>

#include "clog/core/run/travel_speed.hpp"
#include "clog/core/tools/byte_archive.hpp"

namespace clog {

/// r(t) of one run at evenly spaced times, in bounded memory: when it is full, every other sample is dropped
/// and the spacing doubles.
class DisplacementRecord {
 public:
  /// To be called once per check of a run, at equal time intervals.
  void add(double time, double displacement);

  /// Speed of travel between the end of the transient and the moment after which the droplet comes no farther
  /// than 0.01 sigma. Not a number when it travelled less than half a diameter in that time, or as
  /// travel_speed() says.
  TravelSpeed travel_speed() const;

  void save(ByteWriter& bytes) const;
  /// @throws Error if it cannot be what save() wrote after a check at this time [t0]
  void restore(ByteReader& bytes, double time);

 private:
  std::vector<TravelSample> samples_;
  std::int64_t stride_ = 1;
  std::int64_t count_ = 0;
};

}  // namespace clog

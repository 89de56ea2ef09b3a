#pragma once

#include <cstdint>
#include <vector>

#include "clog/core/run/travel_speed.hpp"
#include "clog/core/tools/byte_archive.hpp"

namespace clog {

/// r(t) of one run at evenly spaced times, in bounded memory: when the memory is full, every other sample is
/// dropped, and the spacing doubles.
class DisplacementRecord {
 public:
  /// Call this once per check of a run, at equal time intervals.
  void add(double time, double displacement);

  /// Mean speed between two moments: the end of the transient, and the moment after which the droplet
  /// advances by at most 0.01 sigma. NaN if the droplet travelled less than half a diameter in that time, or
  /// if travel_speed() gives NaN.
  TravelSpeed travel_speed() const;

  void save(ByteWriter& bytes) const;
  /// @throws Error if save() cannot have written these bytes after a check at this time [t0]
  void restore(ByteReader& bytes, double time);

 private:
  std::vector<TravelSample> samples_;
  std::int64_t stride_ = 1;
  std::int64_t count_ = 0;
};

}  // namespace clog

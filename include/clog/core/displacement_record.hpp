#pragma once

#include <cstdint>
#include <vector>

#include "clog/core/byte_archive.hpp"

namespace clog {

/// r(t) of one run at evenly spaced times, in bounded memory: when it is full, every other sample is dropped
/// and the spacing doubles.
class DisplacementRecord {
 public:
  /// To be called once per check of a run, at equal time intervals.
  void add(double time, double displacement);

  /// Speed of travel: least-squares slope of r(t) between the end of the first tenth of the way in time and
  /// the moment after which the droplet comes no farther than 0.01 sigma [sqrt(sigma g)].
  /// NaN when it travelled less than half a diameter in that time, or fewer than 8 samples lie in it.
  double mean_speed() const;

  void save(ByteWriter& bytes) const;
  void restore(ByteReader& bytes);

 private:
  struct Sample {
    double time, displacement;
  };
  std::vector<Sample> samples_;
  std::int64_t stride_ = 1;
  std::int64_t count_ = 0;
};

}  // namespace clog

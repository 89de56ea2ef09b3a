#pragma once

#include <limits>

#include "clog/core/tools/byte_archive.hpp"

namespace clog {

/// An extreme value, and the position h in the channel at which it occurred [sigma]; NaN if there is none.
struct Extreme {
  double value = std::numeric_limits<double>::quiet_NaN();
  double place = std::numeric_limits<double>::quiet_NaN();
};

/// The extremes of a passage through a channel.
struct Passage {
  Extreme largest_shape_parameter;
  Extreme largest_speed;  ///< speed along the flow [V_t]
  /// Speed along the flow [V_t]. The beginning is excluded, because the droplet starts from rest.
  Extreme smallest_speed;

  /// @param is_falling  whether the droplet has had time to reach its terminal speed
  void add(double place, double shape_parameter, double speed, bool is_falling);
  void save(ByteWriter& bytes) const { bytes.put(*this); }
  void restore(ByteReader& bytes) { bytes.get(*this); }
};

}  // namespace clog

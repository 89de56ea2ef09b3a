#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "clog/fit/clogging_length.hpp"

namespace clog::fit {

/// Sets of runs in which one distance or all distances are impossible, as in a damaged table.
inline std::vector<std::vector<Observation>> absurd_runs() {
  const std::vector<Observation> sane{{1, true}, {2, true}, {3, true}, {4, false}};
  std::vector<std::vector<Observation>> all;
  for (const double absurd : {1e308, -1e308, 1e300, -1e300, 5e-324, -5e-324, 1e-310,
                              std::numeric_limits<double>::infinity(), std::nan("")}) {
    for (std::size_t i = 0; i < sane.size(); ++i) {
      all.push_back(sane);
      all.back()[i].distance = absurd;
    }
    all.push_back(std::vector<Observation>(4, {absurd, true}));
    all.push_back({{absurd, true}, {absurd / 2, true}, {absurd / 3, false}});
  }
  all.push_back({{1e308, true}, {5e-324, true}, {1, false}});
  all.push_back({{1, true}, {std::nextafter(1, 2), true}});
  return all;
}

/// Whether a length is possible. A length may also be unknown.
inline bool is_length_or_unknown(double length) {
  return std::isnan(length) || (length >= 0 && std::isfinite(length));
}

}  // namespace clog::fit

#pragma once

#include <string>

namespace clog::single_run {

/// Upper bound of the cost of runs. It assumes that no run ends before max-time.
struct MostCost {
  double time = 0;  ///< [t0]
  double steps = 0;
  double seconds = 0;  ///< computing time on this machine
  double samples = 0;
  double polygons = 0;
  double polygon_bytes = 0;

  MostCost& operator+=(const MostCost& other);
};
/// Prints the config, and the cost as comments, on the standard output. Returns the exit code.
int print_preview(const std::string& config, const MostCost& cost);

}  // namespace clog::single_run

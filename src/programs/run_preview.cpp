#include "run_preview.hpp"

#include <cstdio>
#include <iostream>

#include "clog/cli/program.hpp"
#include "duration.hpp"

namespace clog {

MostCost& MostCost::operator+=(const MostCost& other) {
  time += other.time;
  steps += other.steps;
  seconds += other.seconds;
  samples += other.samples;
  polygons += other.polygons;
  polygon_bytes += other.polygon_bytes;
  return *this;
}

int print_preview(const std::string& config, const MostCost& cost) {
  std::cout << config;
  std::printf("# at most %.4g t0 in %.4g steps: %s on this machine; one that clogs or passes ends sooner\n",
              cost.time, cost.steps, readable_duration(cost.seconds).c_str());
  std::printf("# at most %.0f samples", cost.samples);
  if (cost.polygons > 0) std::printf(" and %.0f polygons (%.3g MB)", cost.polygons, cost.polygon_bytes / 1e6);
  std::printf("\n");
  return cli::exit_success;
}

}  // namespace clog

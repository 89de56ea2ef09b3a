#include "clog/watch/preview.hpp"

#include <cmath>
#include <cstdio>
#include <iostream>

#include "clog/console/duration.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::watch {

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
  const std::string duration = cost.seconds < 1 ? "below 1 s" : console::readable_duration(cost.seconds);
  std::printf("# at most %.4g t0 in %.4g steps: %s on this machine; one that clogs or passes ends sooner\n",
              cost.time, cost.steps, duration.c_str());
  std::printf("# at most %s", sweep::counted(std::llround(cost.samples), "sample").c_str());
  if (cost.polygons > 0)
    std::printf(" and %s (%.3g MB)", sweep::counted(std::llround(cost.polygons), "polygon").c_str(),
                cost.polygon_bytes / 1e6);
  std::printf("\n");
  return console::exit_success;
}

}  // namespace clog::watch

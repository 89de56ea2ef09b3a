#include "clog/single_run/preview.hpp"

#include <fmt/ostream.h>

#include <cmath>
#include <iostream>

#include "clog/console/duration.hpp"
#include "clog/console/exit_codes.hpp"
#include "clog/core/tools/wording.hpp"

namespace clog::single_run {

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
  fmt::print(
      std::cout,
      "# at most {:.4g} t0 in {:.4g} steps: {} on this machine; one that clogs or passes ends sooner\n",
      cost.time, cost.steps, duration);
  fmt::print(std::cout, "# at most {}", count_text(std::llround(cost.samples), "sample"));
  if (cost.polygons > 0)
    fmt::print(std::cout, " and {} ({:.3g} MB)", count_text(std::llround(cost.polygons), "polygon"),
               cost.polygon_bytes / 1e6);
  std::cout << '\n';
  return console::exit_success;
}

}  // namespace clog::single_run

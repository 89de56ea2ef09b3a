/// Measures what a saturated obstacle array costs: the time to build it, the memory to build it, and the
/// memory that it keeps.
///   bench_array [box [boxes]]

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "clog/core/world/obstacle_array.hpp"

namespace {

double peak_mebibytes() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace

int main(int argc, char** argv) {
  const clog::ObstacleParameters parameters{.gap = 0.2,
                                            .diameter = 0.3,
                                            .density = {},
                                            .box = argc > 1 ? std::atof(argv[1]) : 500,
                                            .boxes = argc > 2 ? std::atoi(argv[2]) : 1};
  const double before = peak_mebibytes();
  double first_peak = 0;
  std::size_t num_obstacles = 0;
  std::vector<double> seconds;
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const std::clock_t begin = std::clock();
    const clog::ObstacleArray array = clog::sample_obstacles(parameters, seed);
    seconds.push_back(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    num_obstacles = array.obstacles().size();
    if (seed == 1) first_peak = peak_mebibytes() - before;
  }
  std::sort(seconds.begin(), seconds.end());
  std::printf("%d boxes of %.0f: %zu obstacles in %.2f s of CPU time, at most %.0f MiB meanwhile\n",
              parameters.boxes, parameters.box, num_obstacles, seconds[2], first_peak);
}

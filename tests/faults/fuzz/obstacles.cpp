/// Obstacle files, as for clogrun --obstacles.

#include <cmath>

#include "clog/cli/obstacle_file.hpp"
#include "fuzz.hpp"
#include "memory_file.hpp"

using namespace clog;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file({data, size});
  may_be_refused([&] {
    const double box = 10;
    const ObstacleArray array =
        cli::read_obstacles(file.path(), {.period = box, .default_diameter = 0.3, .narrowest_gap = 0.02});
    require(array.closest_pair().gap > 0);
  });
  return 0;
}

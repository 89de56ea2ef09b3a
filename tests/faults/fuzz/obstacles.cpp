/// Fuzz target that reads files of user-supplied circles.

#include "clog/cli/obstacle_file.hpp"
#include "clog/core/run/resolve.hpp"
#include "fuzz.hpp"
#include "memory_file.hpp"

using namespace clog;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file({data, size});
  may_be_refused([&] {
    RunParameters run;
    run.obstacles.layout = ObstacleLayout::file;
    run.obstacles.own = cli::read_circles(file.path());
    run.obstacles.box = 10;
    require(resolve(run).obstacles.gap > 0);
  });
  return 0;
}

/// Measured profiles and speeds, as for clogfit calibrate and clogfit drag.

#include "clog/laboratory/profile_file.hpp"

#include "fuzz.hpp"
#include "memory_file.hpp"

using namespace clog;
using namespace clog::laboratory;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file({data, size});
  const laboratory::ProfileScales scales{.diameter = 3e-3, .terminal_speed = 1e-3};
  may_be_refused([&] { require(read_profile(file.path(), scales).size() >= 3); });
  may_be_refused([&] { read_near_wall_speeds(file.path(), scales); });
  return 0;
}

/// Fuzz target that reads the file of a sweep.

#include "clog/store/run_table.hpp"
#include "fuzz.hpp"
#include "memory_file.hpp"

using namespace clog;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file({data, size});
  may_be_refused([&] { store::read_sweep(file.path()); });
  return 0;
}

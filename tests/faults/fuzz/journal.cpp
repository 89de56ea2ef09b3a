/// Fuzz target that reads the journal of a sweep.

#include "clog/store/journal.hpp"

#include "fuzz.hpp"
#include "memory_file.hpp"

using namespace clog;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file({data, size});
  may_be_refused([&] {
    const auto contents = store::Journal::look(file.path());
    require(contents && contents->num_bytes <= size &&
            contents->has_torn_end == (contents->num_bytes < size));
  });
  return 0;
}

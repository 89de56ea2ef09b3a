#include "clog/core/tools/memory.hpp"

#include <fmt/core.h>
#include <sys/mman.h>

#include "clog/core/tools/error.hpp"

namespace clog {

void require_memory(const std::string& purpose, std::size_t bytes) {
  // Reserves addresses, but never touches them. They count against limits without using memory.
  void* const trial =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (trial == MAP_FAILED)
    throw Error(fmt::format("cannot {} (out of memory: it takes {} MB more); allow more (ulimit -v)", purpose,
                            (bytes + 999'999) / 1'000'000));
  munmap(trial, bytes);
}

}  // namespace clog

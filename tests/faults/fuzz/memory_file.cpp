#include "memory_file.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

namespace clog {

MemoryFile::MemoryFile(std::span<const std::uint8_t> content)
    : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)) {
  const auto size = static_cast<ssize_t>(content.size());
  if (descriptor_ < 0 || write(descriptor_, content.data(), content.size()) != size) std::abort();
}

MemoryFile::~MemoryFile() { close(descriptor_); }

}  // namespace clog

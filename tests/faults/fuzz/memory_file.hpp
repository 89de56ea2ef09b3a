#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace clog {

/// A file of the given bytes in memory, for readers that need a path.
class MemoryFile {
 public:
  explicit MemoryFile(std::span<const std::uint8_t> content);
  MemoryFile(MemoryFile&&) = delete;
  ~MemoryFile();
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

}  // namespace clog

#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace clog::results {

/// Whether a sweep's file and the journal beside it are undamaged.
struct Verification {
  std::vector<std::string> findings;  ///< a line for each finding, then a summary
  std::int64_t num_faults = 0;
};
/// @throws Error if the file or its journal cannot be read
Verification verify(const std::string& path);

}  // namespace clog::results

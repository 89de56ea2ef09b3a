#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace clog::results {

/// Are a sweep's file and the journal beside it undamaged?
struct Verification {
  std::vector<std::string> findings;  ///< a line for each fault, then what is there
  std::int64_t num_faults = 0;
};
/// @throws Error if the file or its journal cannot be read
Verification verify(const std::string& path);

}  // namespace clog::results

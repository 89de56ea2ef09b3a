#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>

#include "clog/core/tools/error.hpp"

/// libFuzzer calls this with every input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace clog {

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Reads an input, which may be refused with an Error. Any other failure is a finding.
template <typename Read>
void may_be_refused(Read read) {
  try {
    read();
  } catch (const Error&) {
    // Most inputs are refused.
  }
}

/// Ends the process unless the condition holds. The condition must hold for every accepted input.
inline void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace clog

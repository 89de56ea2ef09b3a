#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/error.hpp"

namespace clog::test {

/// The message with which resolve() refuses these parameters, or an empty text if resolve() accepts them.
inline std::string refusal_of(const RunParameters& run) {
  try {
    resolve(run);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Expects that resolve() refuses these parameters. The message must be one line that contains the words.
inline void expect_refused(const RunParameters& run, std::string_view words) {
  const std::string message = refusal_of(run);
  EXPECT_NE(message.find(words), std::string::npos) << words << "\nis not in\n" << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

}  // namespace clog::test

#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "clog/core/parameters/refusal.hpp"
#include "clog/core/parameters/schema.hpp"
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

/// Whether a text contains a value of this key, as in `box=5`.
inline bool has_value_of(const std::string& key, const std::string& text) {
  for (std::size_t at = 0; (at = text.find(key + '=', at)) != std::string::npos; ++at)
    if (at == 0 || (std::string_view(" (*").find(text[at - 1]) != std::string::npos)) return true;
  return false;
}

/// Expects that the data of a refusal agree with its text.
inline void expect_data_as_in_text(const clog::Refusal& refusal) {
  const std::string text = refusal.what();
  EXPECT_TRUE(text.starts_with("invalid " + refusal.about().key + '=')) << text;
  for (const Parameter& parameter : parameter_schema()) {
    if (parameter.key == refusal.about().key) continue;
    EXPECT_EQ(refusal.names(parameter.key), has_value_of(parameter.key, text)) << parameter.key << '\n'
                                                                               << text;
  }
  EXPECT_EQ(!refusal.about().added.empty(),
            text.find(") add " + refusal.about().added + '=') != std::string::npos)
      << text;
}

/// Expects that resolve() refuses these parameters. The message must be one line that contains the words.
inline void expect_refused(const RunParameters& run, std::string_view words) {
  const std::string message = refusal_of(run);
  EXPECT_NE(message.find(words), std::string::npos) << words << "\nis not in\n" << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  try {
    resolve(run);
  } catch (const clog::Refusal& refusal) {
    expect_data_as_in_text(refusal);
  } catch (const Error&) {
    // Settings that contradict each other name no key that is to be changed.
  }
}

}  // namespace clog::test

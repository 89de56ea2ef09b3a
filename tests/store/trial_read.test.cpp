#include "trial_read.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <functional>
#include <span>
#include <string>

#include "clog/core/tools/error.hpp"

namespace clog::store {
namespace {

/// Every call tries different bytes, because the result for the same bytes is cached.
std::string refusal(const std::function<void()>& read) {
  static int number = 0;
  ++number;
  try {
    try_in_child(std::as_bytes(std::span(&number, 1)), "some.h5", read);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(TryInChild, PassesWhatCanBeRead) {
  EXPECT_EQ(refusal([] {}), "");
}

TEST(TryInChild, LeavesErrorsToTheReadingItself) {
  EXPECT_EQ(refusal([] { throw Error("cannot read some.h5"); }), "");
}

TEST(TryInChild, SurvivesADeathAndNamesIt) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGXCPU}) {
    const std::string words = refusal([=] { std::raise(signal); });
    EXPECT_EQ(words.find("cannot read some.h5 (damaged: reading it ends with "), 0) << words;
  }
  EXPECT_NE(refusal([] { std::_Exit(3); }).find("reading it fails"), std::string::npos);
}

TEST(TryInChild, TriesTheSameBytesOnce) {
  const std::string bytes = "bytes of a file";
  const auto image = std::as_bytes(std::span(bytes));
  const auto die = [] { std::raise(SIGSEGV); };
  EXPECT_THROW(try_in_child(image, "some.h5", die), Error);
  EXPECT_THROW(try_in_child(image, "some.h5", [] {}), Error) << "the outcome is known";
  EXPECT_NO_THROW(try_in_child(image.first(5), "some.h5", [] {}));
  EXPECT_NO_THROW(try_in_child(image.first(5), "some.h5", die));
}

}  // namespace
}  // namespace clog::store

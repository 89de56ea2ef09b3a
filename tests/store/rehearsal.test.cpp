#include "rehearsal.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <functional>
#include <string>

#include "clog/core/tools/error.hpp"

namespace clog::store {
namespace {

std::string refusal(const std::function<void()>& read) {
  try {
    rehearse("some.h5", read);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Rehearse, PassesWhatCanBeRead) {
  EXPECT_EQ(refusal([] {}), "");
}

TEST(Rehearse, LeavesErrorsToTheReadingItself) {
  EXPECT_EQ(refusal([] { throw Error("cannot read some.h5"); }), "");
}

TEST(Rehearse, SurvivesADeathAndNamesIt) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGXCPU}) {
    const std::string words = refusal([=] { std::raise(signal); });
    EXPECT_EQ(words.find("cannot read some.h5 (damaged: reading it ends with "), 0) << words;
  }
  EXPECT_NE(refusal([] { std::_Exit(3); }).find("reading it fails"), std::string::npos);
}

}  // namespace
}  // namespace clog::store

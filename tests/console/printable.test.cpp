#include "clog/console/printable.hpp"

#include <gtest/gtest.h>

namespace clog::console {
namespace {

TEST(Printable, KeepsWhatCanBeRead) {
  EXPECT_EQ(printable(""), "");
  EXPECT_EQ(printable("seeds=1..5 \\ 'a'"), "seeds=1..5 \\ 'a'");
  EXPECT_EQ(printable("gr\u00f6\u00dfe \u03bb/\u03c3 \u6db2\u6ef4 \U0001f4a7"),
            "gr\u00f6\u00dfe \u03bb/\u03c3 \u6db2\u6ef4 \U0001f4a7");
}

TEST(Printable, ShowsControlCharacters) {
  EXPECT_EQ(printable("a\nb\tc\rd"), "a\\nb\\tc\\rd");
  EXPECT_EQ(printable("\x1b[31m\x7f\x01"), "\\x1b[31m\\x7f\\x01");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\u009b31m"), "\\xc2\\x9b31m") << "an escape sequence in one character";
}

TEST(Printable, ShowsBytesThatAreNoText) {
  EXPECT_EQ(printable("\xff"
                      "a"),
            "\\xffa");
  EXPECT_EQ(printable("\xc3"), "\\xc3") << "a character that is cut off";
  EXPECT_EQ(printable("\xe2\x82"
                      "a"),
            "\\xe2\\x82"
            "a");
  EXPECT_EQ(printable("\xc0\x8a"), "\\xc0\\x8a") << "a line feed in two bytes";
}

}  // namespace
}  // namespace clog::console

#include "clog/console/duration.hpp"

#include <gtest/gtest.h>

namespace clog::console {
namespace {

TEST(Duration, IsInTheUnitThatSuitsIt) {
  EXPECT_EQ(readable_duration(0), "0 s");
  EXPECT_EQ(readable_duration(89.4), "89 s");
  EXPECT_EQ(readable_duration(119.4), "119 s");
  EXPECT_EQ(readable_duration(119.6), "2 min 00 s");
  EXPECT_EQ(readable_duration(185), "3 min 05 s");
  EXPECT_EQ(readable_duration(600), "10 min");
  EXPECT_EQ(readable_duration(5399), "90 min");
  EXPECT_EQ(readable_duration(5400), "1.5 h");
  EXPECT_EQ(readable_duration(172'799), "48.0 h");
  EXPECT_EQ(readable_duration(172'800), "2.0 days");
}

}  // namespace
}  // namespace clog::console

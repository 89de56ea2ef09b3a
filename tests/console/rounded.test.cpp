#include "clog/console/rounded.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace clog::console {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

TEST(Plain, HasAsManyFiguresAsWanted) {
  EXPECT_EQ(plain(0.12345), "0.123");
  EXPECT_EQ(plain(-1234.5), "-1230");
  EXPECT_EQ(plain(9.996), "10.0") << "one place more after rounding";
  EXPECT_EQ(plain(0), "0.00");
  EXPECT_EQ(plain(0.00010004, 4), "0.0001000");
  EXPECT_EQ(plain(2.0 / 3, 8), "0.66666667");
}

TEST(Plain, HasAnExponentWhereZerosWouldHideTheNumber) {
  EXPECT_EQ(plain(123'456), "123000");
  EXPECT_EQ(plain(1e6), "1.00e+06");
  EXPECT_EQ(plain(999'900), "1.00e+06") << "beyond the bound after rounding";
  EXPECT_EQ(plain(1.5e-5), "1.50e-05");
  EXPECT_EQ(plain(1e100), "1.00e+100");
}

TEST(Plain, IsADashWithoutANumber) {
  EXPECT_EQ(plain(infinite), "-");
  EXPECT_EQ(plain(std::numeric_limits<double>::quiet_NaN()), "-");
}

TEST(RoundedInterval, HasTwoFiguresOfTheNarrowerSide) {
  const RoundedInterval wide = with_interval(233.4, 106.1, 610.9);
  EXPECT_EQ(wide.value + " " + wide.lower + " " + wide.upper, "233 106 611");
  const RoundedInterval narrow = with_interval(233.4, 233.25, 610.9);
  EXPECT_EQ(narrow.value + " " + narrow.lower + " " + narrow.upper, "233.40 233.25 610.90");
}

TEST(RoundedError, GivesItsPlacesToTheValue) {
  const RoundedError usual = with_error(0.375321, 0.00688);
  EXPECT_EQ(usual.value + " " + usual.error, "0.3753 0.0069");
  const RoundedError carried = with_error(0.2, 0.000996);
  EXPECT_EQ(carried.value + " " + carried.error, "0.2000 0.0010");
  const RoundedError tiny = with_error(0.730780239914, 3.8e-11);
  EXPECT_EQ(tiny.value + " " + tiny.error, "0.73078024 3.8e-11") << "runs that are all alike";
  const RoundedError none = with_error(2, infinite);
  EXPECT_EQ(none.value + " " + none.error, "2.00 -");
}

}  // namespace
}  // namespace clog::console

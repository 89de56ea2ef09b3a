#include "clog/console/decimal_commas.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "clog/core/tools/error.hpp"

namespace clog::console {
namespace {

TEST(DecimalCommas, MaySeparateThousandsOnlyInFullGroupsOfDigits) {
  for (const char* number : {"1,350", "-12,345", "+999,000", "12,345,678"})
    EXPECT_TRUE(may_have_thousands(number)) << number;
  for (const char* number : {"0,350", "-0,350", "1,35", "1,3500", "1350,000", ",350", "1,350,1", "1350"})
    EXPECT_FALSE(may_have_thousands(number)) << number;
}

TEST(DecimalCommas, AreRefusedWhileEachMaySeparateThousands) {
  DecimalCommas commas;
  EXPECT_EQ(commas.with_point("600"), "600");
  EXPECT_NO_THROW(commas.check("posts.csv"));
  EXPECT_EQ(commas.with_point("1,350"), "1.350");
  try {
    commas.check("posts.csv");
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("posts.csv: '1,350'"), std::string::npos) << error.what();
  }
  EXPECT_EQ(commas.with_point("0,5"), "0.5");
  EXPECT_NO_THROW(commas.check("posts.csv"));
}

TEST(DecimalCommas, AreRefusedBesideDecimalPoints) {
  for (const auto& [first, second] : {std::pair{"0,5", "1.5"}, {"1.5", "0,5"}, {"1.5", "1,350"}}) {
    DecimalCommas commas;
    commas.with_point(first);
    EXPECT_EQ(commas.with_point("2e3"), "2e3");
    try {
      commas.with_point(second);
      FAIL() << first << " and " << second;
    } catch (const Error& error) {
      const std::string said = error.what();
      EXPECT_NE(said.find(std::string("'") + first + "' above"), std::string::npos) << said;
      EXPECT_EQ(said.find(std::string("'") + second + "' has a"), 0U) << said;
    }
  }
}

TEST(DecimalCommas, MaySeparateThousandsWhereCommasSeparateCells) {
  DecimalCommas commas;
  EXPECT_EQ(commas.with_point("x", "1,350", ';'), "1.350");
  EXPECT_EQ(commas.with_point("x", "0,350", ','), "0.350");
  for (const auto& [cell, separator] : {std::pair{"1,350", ','}, {"1,350.5", ';'}, {"0.5", ';'}}) try {
      commas.with_point("x", cell, separator);
      FAIL() << cell;
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find(std::string("x: '") + cell), 0U) << error.what();
    }
}

}  // namespace
}  // namespace clog::console

#include "clog/sweep/value_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <random>
#include <sstream>
#include <string>
#include <utility>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/joined.hpp"
#include "clog/core/tools/wording.hpp"

namespace clog::sweep {
namespace {

using List = std::vector<std::string>;

List numbers(std::string_view text) { return expand_list(text, ValueKind::number, {"auto"}); }

/// The values of the list, joined with blanks. For a list that is refused, the error message after "!".
std::string meaning_of(const std::string& list, ValueKind kind) try {
  return joined(expand_list(list, kind, {}), " ");
} catch (const Error& error) {
  return std::string("!") + error.what();
}

TEST(ExpandList, ReadsTheCasesThatPythonReads) {
  std::ifstream file(VALUE_LISTS);
  int num_cases = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream cells(line);
    std::string kind, list, expected;
    std::getline(std::getline(std::getline(cells, kind, ';'), list, ';'), expected);
    const std::string meaning = meaning_of(list, kind == "number" ? ValueKind::number : ValueKind::integer);
    if (expected.starts_with('!')) {
      EXPECT_TRUE(meaning.starts_with('!')) << list;
      EXPECT_NE(meaning.find(expected.substr(1)), std::string::npos) << list << ": " << meaning;
    } else {
      EXPECT_EQ(meaning, expected) << list;
    }
    ++num_cases;
  }
  EXPECT_GT(num_cases, 40);
}

TEST(ExpandList, TakesWords) { EXPECT_EQ(numbers("auto,2"), (List{"auto", "2"})); }

class Unreadable : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(Unreadable, IsRefusedWithAReason) {
  const auto [text, reason] = GetParam();
  const std::string meaning = meaning_of(text, ValueKind::integer);
  EXPECT_TRUE(meaning.starts_with('!') && meaning.find(reason) != std::string::npos)
      << text << ": " << meaning;
}

INSTANTIATE_TEST_SUITE_P(
    Lists, Unreadable,
    testing::Values(std::pair{"two", "not an integer"}, std::pair{"1.5", "not an integer"},
                    std::pair{"1,1", "twice"}, std::pair{"1..3,2", "twice"},
                    std::pair{"lin(1,2,3)", "not integers"},
                    std::pair{"1..600000,600001..1200000,1200001..1800000", "million values in all"}));

TEST(ToNumber, RefusesWhatIsNotFinite) {
  EXPECT_THROW(to_number("nan"), Error);
  EXPECT_THROW(to_number("inf"), Error);
  EXPECT_THROW(to_number("1.0x"), Error);
  EXPECT_THROW(to_number(""), Error);
}

TEST(ToNumber, TakesOneSignOnly) {
  EXPECT_EQ(to_number("+2"), 2);
  EXPECT_EQ(to_number("-2"), -2);
  for (const char* text : {"+-2", "++2", "-+2", "--2"}) EXPECT_THROW(to_number(text), Error) << text;
}

TEST(ToNumber, AsksAfterADecimalComma) {
  try {
    to_number("0,7");
    FAIL() << "0,7 was taken for a number";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "'0,7' is not a finite number; did you mean 0.7?");
  }
  EXPECT_EQ(with_decimal_point("12,50"), "12.50");
  EXPECT_EQ(with_decimal_point("12,5%"), "12.5%");
  for (const char* other :
       {"", "%", ",%", "12%", "12%,5%", ",", "1,", ",5", "1,2,3", "0.1,5", "1..3,5", "a,b"})
    EXPECT_EQ(with_decimal_point(other), "") << other;
}

TEST(WithPart, PrefersEndings) {
  const std::vector<std::string> names = {"obstacle-diameter", "obstacle-diameter-spread", "box", "dry-run"};
  using All = std::vector<std::string>;
  EXPECT_EQ(with_part("diameter", names), All{"obstacle-diameter"});
  EXPECT_EQ(with_part("obstacle", names), (All{"obstacle-diameter", "obstacle-diameter-spread"}));
  EXPECT_EQ(with_part("diameter-spread", names), All{"obstacle-diameter-spread"});
  for (const char* other : {"", "iameter", "spread-", "ox"})
    EXPECT_TRUE(with_part(other, names).empty()) << other;
}

TEST(Lists, TakeSharesWhereTheKeyDoes) {
  EXPECT_EQ(expand_list("12.0%, 0.35, saturated", ValueKind::number_or_share, {"saturated"}),
            (List{"12%", "0.35", "saturated"}));
  EXPECT_THROW(expand_list("12%", ValueKind::number, {}), NumberWithUnit);
  for (const char* other : {"%", "12%%", "a%", "1..3%", "12 %5"})
    EXPECT_THROW(expand_list(other, ValueKind::number_or_share, {}), Error) << other;
}

TEST(Lists, OfAnyNumbersHaveNoRanges) {
  for (const char* range : {"0.1..0.5", "0.1..0.5:0.1"}) {
    try {
      expand_list(range, ValueKind::number, {});
      FAIL() << range << " was taken";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("lin(0.1,0.5,5)"), std::string::npos) << error.what();
    }
  }
}

/// Numbers of all magnitudes and both signs. Half of them have few digits.
std::vector<double> numbers_of_all_kinds() {
  std::mt19937_64 random(1);
  std::vector<double> numbers;
  while (numbers.size() < 20'000) {
    const auto any = std::bit_cast<double>(random());
    if (std::isfinite(any)) numbers.push_back(any);
    numbers.push_back(static_cast<double>(random() % 10'000) *
                      std::pow(10, static_cast<int>(random() % 40) - 20));
  }
  return numbers;
}

TEST(Shortest, ReadsBackExactly) {
  for (const double value : numbers_of_all_kinds()) ASSERT_EQ(to_number(shortest(value)), value);
}

TEST(Shortest, IsNoLongerThanAnyTextThatReadsBack) {
  for (const double value : numbers_of_all_kinds()) {
    std::ostringstream other;
    other << std::setprecision(15) << value;
    if (std::strtod(other.str().c_str(), nullptr) == value) {
      ASSERT_LE(shortest(value).size(), other.str().size()) << other.str();
    }
  }
}

/// These texts are a part of the identity of rows. If the texts changed, existing rows would count as other
/// runs.
TEST(Shortest, IsWrittenAsPeopleDo) {
  const std::pair<double, const char*> texts[] = {{0, "0"},
                                                  {-0.0, "-0"},
                                                  {1, "1"},
                                                  {-2.5, "-2.5"},
                                                  {0.1, "0.1"},
                                                  {1.0 / 3, "0.3333333333333333"},
                                                  {0.001, "0.001"},
                                                  {0.0001, "1e-4"},
                                                  {0.00012, "0.00012"},
                                                  {0.0000123, "1.23e-5"},
                                                  {1e-17, "1e-17"},
                                                  {10'000, "10000"},
                                                  {100'000, "1e5"},
                                                  {200'000, "2e5"},
                                                  {120'000, "120000"},
                                                  {123'456'789, "123456789"},
                                                  {1e15, "1e15"},
                                                  {1e22, "1e22"},
                                                  {-8119132263947012096.0, "-8119132263947012096"},
                                                  {1e100, "1e100"},
                                                  {5e-324, "5e-324"},
                                                  {-1.7976931348623157e308, "-1.7976931348623157e308"}};
  for (const auto& [value, text] : texts) EXPECT_EQ(shortest(value), text);
}

TEST(DidYouMean, FindsNearWordsOnly) {
  const List words{"line-tension", "seeds", "box"};
  EXPECT_EQ(did_you_mean("line-tenson", words), "line-tension");
  EXPECT_EQ(did_you_mean("seed", words), "seeds");
  EXPECT_EQ(did_you_mean("temperature", words), "");
}

}  // namespace
}  // namespace clog::sweep

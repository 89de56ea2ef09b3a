#include "clog/console/csv.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "clog/core/tools/error.hpp"

namespace clog::console {
namespace {

class Csv : public testing::Test {
 protected:
  const std::string path_ =
      (std::filesystem::temp_directory_path() / ("clog_csv_" + std::to_string(getpid()) + ".csv")).string();

  void write(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }
  void TearDown() override { std::filesystem::remove(path_); }

  using Cells = std::vector<std::vector<std::string>>;
  Cells cells() const {
    Cells found;
    read_table(path_, [&](const TableLine& line) { found.push_back(line.cells); });
    return found;
  }
};

TEST_F(Csv, GivesCellsWithoutBlanksAndLinesWithTheirNumbers) {
  write("\xef\xbb\xbfx , y\r\n\n# a comment, with a comma\n  \t\n1,, 2.5 \n");
  std::vector<int> numbers;
  read_table(path_, [&](const TableLine& line) { numbers.push_back(line.number); });
  EXPECT_EQ(numbers, (std::vector<int>{1, 5}));
  EXPECT_EQ(cells(), (Cells{{"x", "y"}, {"1", "", "2.5"}}));
}

TEST_F(Csv, TakesTheSeparatorFromTheFirstLine) {
  write("x;y\n1,5;2,5\n");
  EXPECT_EQ(cells(), (Cells{{"x", "y"}, {"1,5", "2,5"}}));
  write("x\ty\n1;2\t3\n");
  EXPECT_EQ(cells(), (Cells{{"x", "y"}, {"1;2", "3"}}));
  write(" x   y\n1 \t 2 \n");
  EXPECT_EQ(cells(), (Cells{{"x", "y"}, {"1", "2"}}));
  write("sep=;\n1,5;2\n");
  EXPECT_EQ(cells(), (Cells{{"1,5", "2"}}));
}

TEST_F(Csv, KeepsEmptyCellsAtBothEnds) {
  write("\tx\ty\t\n1\t2\t3\t\n");
  EXPECT_EQ(cells(), (Cells{{"", "x", "y", ""}, {"1", "2", "3", ""}}));
}

TEST_F(Csv, TakesQuotesOff) {
  write("\"x\", \"a \"\"b\"\", c\" ,\"\"\n");
  EXPECT_EQ(cells(), (Cells{{"x", "a \"b\", c", ""}}));
  write("\"x,y\n");
  EXPECT_THROW(cells(), Error);
}

TEST_F(Csv, TakesOtherBlanksAndLatin1AsSpreadsheetsWriteThem) {
  write("\xc2\xa0x\xe2\x80\xaf,y [\xb5m]\n");  // not UTF-8, because of the last character
  EXPECT_EQ(cells()[0][1], "y [\xc2\xb5m]");
  write("\xc2\xa0x\xe2\x80\xaf,y [\xc2\xb5m]\n");
  EXPECT_EQ(cells(), (Cells{{"x", "y [\xc2\xb5m]"}}));
  write(std::string("x\0,\0", 4));
  EXPECT_THROW(cells(), Error);
}

TEST_F(Csv, GivesComments) {
  write("# a\n1\n\"# b\"\n");
  std::vector<std::string> comments;
  read_table(
      path_, [](const TableLine&) {}, [&](const std::string& text) { comments.push_back(text); });
  EXPECT_EQ(comments, (std::vector<std::string>{"# a", "\"# b\""}));
}

TEST_F(Csv, SaysWhereAnErrorIs) {
  write("1\n2\n");
  try {
    read_table(path_, [](const TableLine& line) {
      if (line.cells[0] == "2") throw Error("is too many");
    });
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), path_ + " line 2: is too many");
  }
}

TEST(Trimmed, IsWithoutTheBlanksAround) {
  EXPECT_EQ(trimmed(" \t a b\r"), "a b");
  EXPECT_EQ(trimmed(" \r\t"), "");
}

TEST(SurplusCells, AreEmptyAndBeyondTheColumns) {
  EXPECT_EQ(without_surplus_cells({"1", "", "", ""}, 2), (std::vector<std::string>{"1", ""}));
  EXPECT_EQ(without_surplus_cells({"1", "", "2", ""}, 2), (std::vector<std::string>{"1", "", "2"}));
  EXPECT_EQ(without_surplus_cells({"1"}, 2), std::vector<std::string>{"1"});
}

}  // namespace
}  // namespace clog::console

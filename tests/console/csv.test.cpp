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
};

TEST_F(Csv, GivesCellsWithoutBlanksAndLinesWithTheirNumbers) {
  write("\xef\xbb\xbfx , y\r\n\n# a comment, with a comma\n  \t\n1,, 2.5 \n");
  std::vector<int> numbers;
  std::vector<std::vector<std::string>> lines;
  read_csv(path_, [&](int number, const std::vector<std::string>& cells) {
    numbers.push_back(number);
    lines.push_back(cells);
  });
  EXPECT_EQ(numbers, (std::vector<int>{1, 5}));
  EXPECT_EQ(lines, (std::vector<std::vector<std::string>>{{"x", "y"}, {"1", "", "2.5"}}));
}

TEST_F(Csv, SaysWhereAnErrorIs) {
  write("1\n2\n");
  try {
    read_csv(path_, [](int, const std::vector<std::string>& cells) {
      if (cells[0] == "2") throw Error("is too many");
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

}  // namespace
}  // namespace clog::console

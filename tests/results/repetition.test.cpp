#include "clog/results/repetition.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "clog/sweep/columns.hpp"

namespace clog::results {
namespace {

/// A row with known results.
sweep::RunRow known_row() {
  sweep::RunRow row = sweep::describe(RunParameters{});
  row.distance = 3;
  row.dwells.known_from = 2;
  row.dwells.last_distance = row.dwells.last_begin = 0;
  row.contacts.number = 1;
  row.contacts.first_distance = 0.5;
  return row;
}

/// A NaN with other bits than the NaN in files.
double other_nan() { return std::bit_cast<double>(std::uint64_t{0xfff0'0000'0000'0123}); }

TEST(DifferingResults, AreTheColumnsWithOtherValues) {
  const sweep::RunRow row = known_row();
  sweep::RunRow other = row;
  EXPECT_TRUE(differing_results(row, other).empty());
  other.distance = 4;
  other.rank = 7;  // the rank is not a result
  EXPECT_EQ(differing_results(row, other), std::vector<std::string>{"distance"});
}

TEST(DifferingResults, AreNeverTwoNaN) {
  int num_columns = 0;
  for (const sweep::Column& column : sweep::columns()) {
    if (column.role != sweep::ColumnRole::result || column.kind != ValueKind::number) continue;
    sweep::RunRow row = known_row(), other = known_row();
    column.set(row, sweep::Value());
    column.set(other, sweep::Value(other_nan()));
    EXPECT_TRUE(differing_results(row, other).empty()) << column.name;
    column.set(other, sweep::Value(1.5));
    EXPECT_EQ(differing_results(row, other), std::vector<std::string>{column.name});
    ++num_columns;
  }
  EXPECT_GT(num_columns, 30);
}

}  // namespace
}  // namespace clog::results

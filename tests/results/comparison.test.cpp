#include "clog/results/comparison.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <stdexcept>

namespace clog::results {
namespace {

TEST(Comparison, HasTwoSidesOrMore) {
  EXPECT_THROW(compare({}, 0.95, std::nullopt), std::invalid_argument);
  EXPECT_THROW(compare({Side{"a.h5", {sweep::RunRow()}, {}}}, 0.95, std::nullopt), std::invalid_argument);
}

}  // namespace
}  // namespace clog::results

#pragma once

#include <string>
#include <vector>

#include "clog/sweep/run_row.hpp"

namespace clog::results {

/// Replay of one run of a sweep.
struct Repetition {
  sweep::RunRow row;
  std::vector<std::string> differing;  ///< columns of results whose bits differ from the row
};
/// Columns of results in which two rows of the same run differ; all NaN are equal.
std::vector<std::string> differing_results(const sweep::RunRow& a, const sweep::RunRow& b);
/// @param row  see replayable_row()
Repetition repeat(const sweep::RunRow& row);

}  // namespace clog::results

#pragma once

#include <string>
#include <vector>

#include "clog/sweep/run_row.hpp"

namespace clog::campaign {

/// One run of a sweep, done once more.
struct Repetition {
  sweep::RunRow row;
  std::vector<std::string> differing;  ///< columns of results that have other bits than the first time
};
/// @param row  see replayable_row()
Repetition repeat(const sweep::RunRow& row);

}  // namespace clog::campaign

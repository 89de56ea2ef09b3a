#pragma once

#include <string>
#include <vector>

#include "clog/sweep/run_row.hpp"

namespace clog::results {

/// Replay of one run of a sweep.
struct Repetition {
  sweep::RunRow row;
  std::vector<std::string> differing;  ///< columns of results with bits that differ from the row
};
/// Whether two members of families are equal, bit for bit.
bool are_equal(const Member& a, const Member& b);
/// Columns of results in which two rows of the same run differ; all NaN are equal. `droplets` is one of them
/// if the families of the rows differ.
std::vector<std::string> differing_results(const sweep::RunRow& a, const sweep::RunRow& b);
/// @param row  see replayable_row()
Repetition repeat(const sweep::RunRow& row);

/// The member of the row's family that has this path. @throws Error that lists the paths of all daughters
const Member& member_of(const sweep::RunRow& row, const std::string& path);
/// The row's family, from its beginning.
FamilyRun family_of(const sweep::RunRow& row);

}  // namespace clog::results

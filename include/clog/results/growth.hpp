#pragma once

#include <set>
#include <string>
#include <vector>

#include "clog/sweep/plan.hpp"
#include "clog/sweep/run_row.hpp"
#include "clog/sweep/settings.hpp"

/// A sweep may grow along numerical physical parameters, and in seeds. All other keys are fixed: a file and
/// the sweep that resumes it must have at least one common value of each fixed key.
namespace clog::results {

/// Names the fixed keys for which two sweeps have no value in common; empty if one sweep may continue the
/// other.
std::string differing_keys(const sweep::Settings& there, const sweep::Settings& here);

/// The plan's values of the fixed keys. A row with another value of such a key belongs to another sweep.
/// Automatic values are not compared, because they may follow from line tensions and gaps of an earlier plan.
class FixedValues {
 public:
  FixedValues(const sweep::Plan& plan, sweep::Settings settings);

  /// Names the fixed keys whose value in this row occurs in no task of the plan. Also names the model version
  /// if it differs.
  std::string differing_keys(const sweep::RunRow& row) const;

 private:
  struct Fixed {
    const sweep::Key* key;
    std::set<ParameterValue> values;
  };
  sweep::Settings settings_;
  std::vector<Fixed> keys_;
};

}  // namespace clog::results

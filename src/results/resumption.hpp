#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clog/results/sweep_runs.hpp"
#include "clog/store/journal.hpp"
#include "clog/store/run_table.hpp"
#include "clog/sweep/plan.hpp"

namespace clog::results {

/// A sweep that may have earlier sessions.
struct Resumption {
  const std::string& path;
  const sweep::Plan& plan;
  const sweep::Settings& settings;
  std::int64_t num_wanted;  ///< number of tasks at the start of the plan that are requested
};

/// Takes the runs from the table and the journal of earlier sessions, and assigns them to their tasks.
/// Returns the number of physically impossible rows; these rows are excluded. @throws Error if the table or
/// the journal belongs to another sweep
std::int64_t adopt(const Resumption& sweep, store::SweepFile table,
                   std::vector<store::Journal::Entry> records, SweepRuns& runs);

}  // namespace clog::results

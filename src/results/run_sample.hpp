#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clog/results/cost.hpp"
#include "clog/sweep/job.hpp"
#include "clog/sweep/plan.hpp"

namespace clog::results {

double work_per_step(const RunParameters& run);

/// A sample of a sweep's runs, used to estimate the cost of the sweep.
struct Sample {
  std::vector<RunCost> costs;
  std::string source;
  std::string failure;  ///< why the first run that could not begin failed; such runs are not in `costs`
  std::int64_t num_clogged = 0;
  std::int64_t num_short = 0;  ///< clogged runs that ended within one obstacle spacing of their release
  double spacing = 0;          ///< obstacle spacing of one of these short runs [sigma]
  bool has_own_circles = false;

  void count(const sweep::RunRow& row);
};

/// The sample of runs that the sweep's file already contains; empty without a file.
struct StoredSample {
  Sample sample;
  std::vector<WaitingRuns> waiting;  ///< runs of each parameter set that are not in the sample
  std::int64_t num_done = 0;         ///< tasks that need not run again
  double seconds = 0;                ///< time that the tasks have taken so far

  static constexpr std::size_t fewest_runs = 5;
  bool knows_enough() const { return sample.costs.size() >= fewest_runs; }
};
StoredSample stored_runs(const sweep::Plan& plan, const std::string& path);

/// Runs short pieces of some tasks. Another process may compute the jobs; it answers between slices of its
/// work. Jobs that take too long are dropped, for instance if the droplet does not come to rest at its
/// release.
Sample tried_sample(const sweep::Plan& plan, const sweep::JobFactory& jobs);
SweepCost tried_cost(const sweep::Plan& plan, const Sample& sample);

}  // namespace clog::results

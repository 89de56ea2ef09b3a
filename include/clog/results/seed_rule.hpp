#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "clog/core/run/droplet_run.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/settings.hpp"

namespace clog::results {

/// Adds seeds to a sweep, in rounds, until the clogging length of every parameter set is precise enough. The
/// next round depends only on the numbers of clogs and seeds when a round has ended. So the choice of runs
/// depends neither on the number of ranks nor on interruptions. The estimate of lambda stays unbiased:
/// stopping at a number of clogs is inverse sampling, in which the relative width of the interval depends
/// only on this number.
class SeedRule {
 public:
  /// @param precision  required half-width of the 95 % interval divided by lambda
  /// @param first_seeds, most_seeds  number of seeds per parameter set in the first round, and largest number
  /// of seeds
  SeedRule(double precision, std::int64_t num_groups, std::int64_t first_seeds, std::int64_t most_seeds);

  /// Call this when all tasks so far are over. Returns the tasks of the next round; none at the end. Task s *
  /// num_groups + g is the s-th seed of parameter set g. For a set that is not precise enough, the number of
  /// further seeds follows from the set's fraction of clogs so far, but it is at most the number of seeds
  /// that the set already has. A set in which all runs have failed gets no more seeds.
  /// @param status  how a task ended
  std::vector<std::int64_t> next_round(const std::function<RunStatus(std::int64_t task)>& status);

  std::int64_t num_groups() const { return static_cast<std::int64_t>(num_seeds_.size()); }
  /// Number of clogs that a parameter set needs to be precise enough.
  std::int64_t clogs_needed() const;
  double precision() const { return precision_; }
  std::int64_t most_seeds() const { return most_seeds_; }
  /// Number of parameter sets that were precise enough at the last next_round().
  std::int64_t num_reached() const { return num_reached_; }
  /// The clogs and seeds of a parameter set that did not reach the precision.
  struct Unreached {
    std::int64_t group, num_clogs, num_seeds, num_failed;
  };
  const std::vector<Unreached>& unreached() const { return unreached_; }
  /// The rule in words, as it is stored with the result.
  std::string text() const;

 private:
  double precision_;
  std::int64_t most_seeds_;
  std::vector<std::int64_t> num_seeds_;  // number of seeds of each parameter set, in all rounds so far
  std::int64_t num_reached_ = 0;
  std::vector<Unreached> unreached_;
};

/// The outcome in one line. It names the parameter sets that used all seeds before they reached the
/// precision, and a remedy. If all sets reached the precision, the line contains the number of sets.
std::string outcome(const SeedRule& rule, const sweep::Plan& plan);

/// A sweep that a rule may enlarge. Its settings have all seeds that the rule may use, beginning with the
/// given seeds.
struct GrowingSweep {
  sweep::Settings settings;
  std::int64_t num_first = 0;  ///< tasks to begin with
  SeedRule rule;
};
/// @param precision, most_seeds  see SeedRule @throws Error if there are too few seeds
GrowingSweep growing_sweep(const sweep::Settings& settings, double precision, std::int64_t most_seeds);

}  // namespace clog::results

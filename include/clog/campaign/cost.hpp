#pragma once

#include <cstdint>
#include <span>

namespace clog::campaign {

/// What one run of a sweep has cost so far. Work is counted in steps times vertices.
struct RunCost {
  std::int64_t parameter_set = 0;
  double begin_seconds = 0;  ///< until it moved: its obstacles, its release
  double seconds = 0;        ///< since then
  double work = 0;           ///< done in these seconds
  double longest_work = 0;   ///< if it goes on to max-time
  bool is_over = false;
};

/// Runs of one parameter set that have not begun.
struct WaitingRuns {
  std::int64_t parameter_set = 0;
  std::int64_t number = 0;
  double longest_work = 0;  ///< of each
};

/// Computing time of a whole sweep, or of what is left of it [s].
struct SweepCost {
  double seconds_per_work = 0;
  double bound = 0;  ///< if every run goes on to max-time
  /// What is to be expected, and roughly a 95 % interval of it.
  double expected = 0;
  double lower = 0;
  double upper = 0;
};

/// From some of its runs, which were begun as if drawn at random.
///
/// How long the unfinished ones will go on is judged by how the sample fared lately, from half the shortest
/// time on that an unfinished one has had; early ends say little of that. The low end of the interval takes
/// late ends for exponential, the high end for those of a mixture of short and long runs, whose ends become
/// rarer; the expectation is their geometric mean. A parameter set none of whose runs has ended may be one
/// whose runs go on to max-time: the high end is that, and the expectation takes every order of magnitude for
/// as likely. The interval has the error of each law, joined with that of the sample.
/// @param sample  of at least one run that has done some work, in some time
/// @param all_work  of all runs of the sweep, if every run goes on to max-time
SweepCost sweep_cost(std::span<const RunCost> sample, double all_work, std::int64_t num_runs);

/// What a sweep still costs, from all its runs that have begun. These are no sample of it: long ones are
/// begun first. So each parameter set is judged by itself, as above: what its runs still take by how those
/// fared of which it has one that is over, otherwise by how all did. A set of which none has begun is taken
/// for the mean of all, with an error as large as that.
/// @param begun  at least one that has done some work, in some time
SweepCost cost_left(std::span<const RunCost> begun, std::span<const WaitingRuns> waiting);

}  // namespace clog::campaign

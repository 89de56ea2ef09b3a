#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "clog/fit/fitted_curve.hpp"

/// Which runs a sweep needs next, for its fitted curve to become known: decided in rounds, from the runs that
/// are over.
namespace clog::campaign {

/// The goal of a refinement, and its precision.
struct RefinementGoal {
  enum class Kind { curve, peak, crossing, none };
  Kind kind = Kind::none;
  double precision =
      0;              ///< relative: half of a 95 % interval; of a curve, its root mean square along the curve
  double length = 0;  ///< lambda to be crossed [sigma]

  std::string text() const;
};

/// Runs of one parameter set that are over.
struct RefinedPoint {
  fit::CurvePlace place;
  double num_clogs = 0;
  double distance = 0;  ///< of all [sigma]
  double time = 0;      ///< of all [t0]
  double work = 0;      ///< of all, steps times vertices: what they cost, on whatever machine
};

/// A curve's candidates: every value that it may get, and what a run there is to be expected to come to.
struct RefinementCandidates {
  std::vector<fit::CurvePlace> places;
  double max_time = 0;  ///< of a run [t0]
};

/// The clogs and the work that one more run at a place is expected to bring.
struct ExpectedRun {
  double num_clogs;  ///< p = 1 - exp(-L/lambda)
  double work;
};
std::vector<ExpectedRun> expected_runs(std::span<const RefinedPoint> points,
                                       const RefinementCandidates& candidates,
                                       const Eigen::VectorXd& log_length);

/// The precision reached so far, in the terms of the goal; infinite where nothing is known.
double known_precision(const fit::Curve& curve, std::span<const fit::CurvePlace> places,
                       const RefinementGoal& goal);

/// Limits of the next round, which adds blocks of seeds to candidates.
struct RoundLimits {
  std::int64_t seeds_per_block = 1;
  std::vector<std::int64_t> blocks_left;  ///< that each candidate may still get
  double work = 0;                        ///< of the round, about; at least one block is chosen
  /// The work that the budget still allows: a block that costs more is not chosen.
  double most_work = std::numeric_limits<double>::infinity();
};
/// How many more blocks of seeds each candidate gets. Greedy: each block goes where it lowers the variance of
/// log lambda most for its work. The variance is weighted along the curve by how much each place matters to
/// the goal (rank-one update of the posterior covariance with the expected clogs).
std::vector<std::int64_t> choose_blocks(const fit::Curve& curve, std::span<const ExpectedRun> runs,
                                        const RefinementGoal& goal, RoundLimits limits);

/// Cost of a round as a share of the cost of all earlier rounds: large enough that few rounds suffice, small
/// enough that none is decided on little data.
inline constexpr double share_of_round = 0.5;

}  // namespace clog::campaign

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "clog/fit/clogging_length.hpp"

namespace clog::fit {

/// Outcome of a run that several causes may end. Either one of the causes ended the run after the `distance`
/// [sigma], or the droplet was still moving when it was last seen there (censored).
struct CompetingEnd {
  double distance;
  std::optional<int> cause;
};

/// A step of the estimated F_c(r), the probability to end by cause c within r in the presence of the other
/// causes.
struct IncidenceStep {
  double distance;        ///< distance at which this cause ended one or more runs [sigma]
  int num_at_risk;        ///< runs that reached this distance
  int num_ends;           ///< number of these runs that this cause ended at this distance
  double probability;     ///< F_c just beyond this distance
  double standard_error;  ///< standard error of F_c, by the delta method
  Interval interval;      ///< interval of F_c; NaN where F_c is 1
};

/// Aalen and Johansen's estimate (Scand. J. Stat. 5, 141 (1978)). At every distance with ends, F_c grows by P
/// d_c/n. Here P is the probability to have reached this distance (survival_curve() of all causes), n is the
/// number of runs at risk, and d_c is the number of these runs that cause c ends. So P and the F_c of all
/// causes add up to 1. The sum would not be 1 if F_c were one minus a survival curve in which the ends by
/// other causes are censored.
///
/// There is one step for each distance at which the cause ended runs, in increasing order. At equal
/// distances, ends precede censorings. The variance is that of Dinse and Larson (Biometrika 73, 379 (1986));
/// without censoring it is binomial. Intervals are symmetric in log(-log F_c), like the intervals of
/// survival_curve().
/// @throws std::invalid_argument unless 0 < confidence < 1
std::vector<IncidenceStep> cumulative_incidence(std::span<const CompetingEnd> runs, int cause,
                                                double confidence = 0.95);

}  // namespace clog::fit

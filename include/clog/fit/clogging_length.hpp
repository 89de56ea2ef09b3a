#pragma once

#include <cstdint>
#include <span>

namespace clog::fit {

/// Outcome of one run. Either the droplet clogged after the `distance` [sigma], or it was still moving when
/// it was last seen there (censored).
struct Observation {
  double distance;
  bool clogged;
};

/// Whether all distances are finite. If a distance is not finite, the results of a fit are NaN.
bool all_finite(std::span<const Observation> runs);

struct Interval {
  double lower;
  double upper;
};

/// @throws std::invalid_argument unless 0 < confidence < 1
void require_confidence(double confidence);

/// The z for which a standard normal number is between -z and z with the probability `confidence`. z^2 is the
/// quantile of chi-squared with one degree of freedom. For very small `confidence` z^2 underflows, but z does
/// not.
double normal_deviate(double confidence);

/// Estimate of the clogging length lambda, the mean distance of an exponential law P(r) = exp(-r/lambda)
/// (Cheng et al. Eq. 13).
struct CloggingLength {
  int num_runs = 0;
  int num_clogs = 0;
  double total_distance = 0;  ///< S, sum over all runs, clogged or not [sigma]
  double length = 0;          ///< NaN without clogs [sigma]
  Interval interval{};        ///< interval by chi-squared; without clogs a lower bound and infinity [sigma]
  Interval profile{};         ///< interval by profile likelihood; without clogs like `interval` [sigma]
};

/// Maximum likelihood for censored exponential data: lambda = S/d, with S the sum of all distances and d the
/// number of clogs.
///
/// The interval is 2 S/chi2_{1-q} .. 2 S/chi2_q with q = (1 - confidence)/2. If d is fixed beforehand, or if
/// every run has clogged, 2 S/lambda is chi-squared distributed with exactly 2d degrees of freedom (Epstein
/// and Sobel 1953). Here runs are censored after a given time, so d is as random as S. If the runs ended just
/// before their next clog, 2d + 2 degrees of freedom would be exact. If they ended just after a clog, 2d
/// would be exact. The interval with 2d + 1, the number in between, has nearly the nominal coverage (Cox,
/// Biometrika 40, 354 (1953); Lawless, Statistical Models and Methods for Lifetime Data, ch. 4). Without
/// clogs there is a one-sided lower bound, S/log(1/(1 - confidence)), which corresponds to 2d + 2 degrees of
/// freedom.
///
/// `profile` contains all lambda for which 2 (l(S/d) - l(lambda)) is below the quantile of chi-squared with
/// one degree of freedom, where l(lambda) = -d log lambda - S/lambda.
///
/// Distances below zero (a droplet pushed back on release) count as zero. All lengths are NaN where the sum
/// of the distances is not finite.
/// @throws std::invalid_argument unless 0 < confidence < 1
CloggingLength fit_clogging_length(std::span<const Observation> runs, double confidence = 0.95);

/// Half of the chi-squared interval's width divided by the estimate; infinite without clogs. The function
/// assumes that all runs have clogged; with censored runs the interval is a little narrower.
double relative_half_width(std::int64_t num_clogs, double confidence = 0.95);

/// Least squares of exp(-r/lambda) on P(r) = 1 - N_clog(r)/N at every clog, as published (Cheng et al.,
/// appendix C) [sigma]. This length is biased, because the method treats censored runs as if they never
/// clogged, and the points as if they were independent. NaN for fewer than two clogs, and for distances that
/// are not finite.
double least_squares_length(std::span<const Observation> runs);

}  // namespace clog::fit

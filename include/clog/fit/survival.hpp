#pragma once

#include <span>
#include <vector>

#include "clog/fit/clogging_length.hpp"

namespace clog::fit {

/// Interval of a probability P between 0 and 1: P^exp(-+ z s/|log P|), where s^2 is the variance of log P.
/// With this interval, log(-log P) has the error s/|log P|. NaN for any other P.
Interval log_log_interval(double probability, double log_variance, double confidence);

/// A step of the estimated P(r), the probability to travel farther than r without a clog.
struct SurvivalStep {
  double distance;        ///< distance at which one or more runs clogged [sigma]
  int num_at_risk;        ///< runs that reached this distance
  int num_clogs;          ///< number of these runs that clogged at this distance
  double probability;     ///< P just beyond this distance
  double standard_error;  ///< standard error of `probability`, by Greenwood's formula
  Interval interval;      ///< interval of P; NaN where P is 0
};
/// Kaplan and Meier's product-limit estimate (J. Am. Stat. Assoc. 53, 457 (1958)). It assumes no law, and
/// censored runs count up to the distance at which they were last seen. There is one step for each distance
/// with clogs, in increasing order. At equal distances, clogs precede censorings. Intervals are symmetric in
/// log(-log P), so that they stay within 0 and 1 (Kalbfleisch and Prentice, The Statistical Analysis of
/// Failure Time Data, ch. 1).
/// @throws std::invalid_argument unless 0 < confidence < 1
std::vector<SurvivalStep> survival_curve(std::span<const Observation> runs, double confidence = 0.95);

/// Tests whether P(r) is an exponential, by the likelihood ratio against Weibull's law P(r) =
/// exp(-(r/scale)^shape). If the shape is above 1, clogs become more frequent with distance. If it is below
/// 1, clogs become rarer, or the runs differ from each other. Distances below a thousandth of the mean are
/// raised to a thousandth of the mean, because Weibull's law excludes zero. The p-value is asymptotic: p <
/// 0.05 occurs in 5, 6.5 and 11 % of exponential samples of 50, 10 and 5 clogs.
struct WeibullTest {
  int num_clogs = 0;
  /// NaN for fewer than two clogs, if nothing moved, or for infinite distances. Infinite if all clogs are at
  /// the longest distance: then the likelihood is infinite, too, and p is 0.
  double shape = 0;
  double scale = 0;                   ///< [sigma]
  double exponential_likelihood = 0;  ///< maximum of the log-likelihood
  double weibull_likelihood = 0;      ///< maximum of the log-likelihood
  double likelihood_ratio = 0;  ///< twice the difference of the maxima; chi-squared, one degree of freedom
  double p_value = 0;           ///< probability of a ratio at least as large if P(r) is exponential
};
WeibullTest test_exponentiality(std::span<const Observation> runs);

/// Finds the groups with a P(r) that is not exponential: groups with p < 0.05 in Holm's step-down test
/// (Scand. J. Stat. 6, 65 (1979)) of all groups with ten clogs or more. If all groups are exponential, only
/// one table in twenty marks any group, however many groups it has. Groups with fewer clogs are not tested,
/// because the p-value would be too small.
std::vector<bool> are_not_exponential(std::span<const WeibullTest> groups);

/// Whether at least half of the distances are equal to another distance. For independent droplets this
/// happens only if the distances were rounded coarsely.
bool are_mostly_equal(std::vector<double> distances);

/// Whether at least half of the distances, and three or more, are at one place: sorted, each follows the one
/// before by at most mean/(100 n). For n independent distances with an exponential law, the probability is
/// below 1.2e-4 for all n.
bool are_mostly_at_one_place(std::vector<double> distances);

}  // namespace clog::fit

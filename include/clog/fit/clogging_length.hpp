#pragma once

#include <span>

namespace clog::fit {

/// What one run says about clogging: it went `distance` [sigma] and clogged there, or was still going when it
/// was last seen (censored).
struct Observation {
  double distance;
  bool clogged;
};

/// Estimate of the clogging length lambda, the mean distance of an exponential law P(r) = exp(-r/lambda)
/// (Cheng et al. Eq. 13).
struct CloggingLength {
  int num_runs = 0;
  int num_clogs = 0;
  double total_distance = 0;  ///< over all runs, clogged or not [sigma]
  double length = 0;          ///< NaN without clogs [sigma]
  double lower = 0;           ///< [sigma]
  double upper = 0;           ///< infinite without clogs [sigma]
};

/// Maximum likelihood for censored exponential data: lambda = (sum of all distances)/(number of clogs).
/// The two-sided interval is 2 S/chi2_{1-q} .. 2 S/chi2_q with q = (1 - confidence)/2 and 2d degrees of
/// freedom, S the sum and d the clogs (Epstein and Sobel 1953; Lawless, Statistical Models and Methods for
/// Lifetime Data, ch. 4). Without clogs, `lower` is the one-sided bound S/log(1/(1 - confidence)). Distances
/// below zero (a droplet pushed back on release) count as zero.
/// @throws std::invalid_argument unless 0 < confidence < 1
CloggingLength fit_clogging_length(std::span<const Observation> runs, double confidence = 0.95);

}  // namespace clog::fit

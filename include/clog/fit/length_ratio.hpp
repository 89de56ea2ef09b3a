#pragma once

#include <span>

#include "clog/fit/clogging_length.hpp"

namespace clog::fit {

/// Two runs with the same obstacles and release, that of each of two sweeps.
struct Pair {
  Observation here;
  Observation there;
  bool is_alike = false;  ///< both end at the same place, or neither clogs: the pair tells no difference
};

/// How many times the clogging length here is that there.
struct LengthRatio {
  double ratio = 0;     ///< NaN without clogs on both sides
  Interval interval{};  ///< of the two that follow; NaN without clogs
  /// From the numbers of clogs, as if all runs were independent: a ratio of two lengths follows Snedecor's F,
  /// with the degrees of freedom of fit_clogging_length().
  Interval unpaired{};
  /// From the scatter over the pairs: the jackknife of log lambda/lambda with Student's t (Miller, Biometrika
  /// 61, 1 (1974)). NaN for fewer than three pairs, or where all pairs but one have no clog.
  Interval paired{};
  double paired_ratio = 0;  ///< of the pairs alone
  bool is_paired = false;   ///< is `interval` the paired one, and `ratio` that of the pairs?
  int num_pairs = 0;
  int num_unlike = 0;  ///< pairs that are not alike
  /// Correlation of the two logarithms over the pairs. Above zero pairing gains: the error of the ratio is
  /// smaller than that of two independent lengths by `gain`.
  double correlation = 0;  ///< NaN where it is not known
  double gain = 0;  ///< standard error without pairing over that with it, from the same pairs; NaN likewise
};

/// The paired interval is taken where pairs gain for sure: the correlation differs from zero (one-sided, 2.5
/// %), and at least ten pairs are unlike. With fewer, those few decide everything, and the interval covers
/// the truth less often than it claims (docs/notes/2026-11-24-paired-intervals.md).
/// @param here, there  all runs, those of pairs included
/// @throws std::invalid_argument unless 0 < confidence < 1
LengthRatio fit_length_ratio(std::span<const Observation> here, std::span<const Observation> there,
                             std::span<const Pair> pairs, double confidence = 0.95);

}  // namespace clog::fit

#pragma once

#include <span>

#include "clog/fit/clogging_length.hpp"

namespace clog::fit {

/// A run of each sweep; both runs have the same obstacles and the same release.
struct Pair {
  Observation here;
  Observation there;
  bool is_alike = false;  ///< the pair shows no difference: both end at the same place, or neither clogs
};

/// Ratio of the clogging length `here` to the clogging length `there`.
struct LengthRatio {
  double ratio = 0;     ///< `here` divided by `there`; NaN without clogs on both sides
  Interval interval{};  ///< `paired` or `unpaired`; NaN without clogs
  /// From the numbers of clogs, as if all runs were independent. A ratio of two lengths follows Snedecor's F
  /// distribution, with the degrees of freedom of fit_clogging_length().
  Interval unpaired{};
  /// From the scatter between the pairs: the jackknife of log(lambda here/lambda there) with Student's t
  /// (Miller, Biometrika 61, 1 (1974)). NaN for fewer than three pairs, or if at most one pair has clogs.
  Interval paired{};
  double paired_ratio = 0;  ///< the ratio from the runs of the pairs alone
  bool is_paired = false;   ///< whether `interval` is `paired`, and `ratio` is `paired_ratio`
  int num_pairs = 0;
  int num_unlike = 0;  ///< pairs that are not alike
  /// Correlation between log lambda here and log lambda there, over the pairs, by the jackknife. If the
  /// correlation is positive, pairing helps: it makes the error of the ratio smaller by the factor `gain`.
  double correlation = 0;  ///< NaN where it is unknown
  double gain = 0;  ///< ratio of the unpaired to the paired standard error of the same pairs; NaN if unknown
};

/// `interval` is the paired interval if pairs certainly help: the correlation is positive (one-sided, 2.5 %),
/// and the two runs of at least ten pairs differ. With fewer differing pairs, the coverage of the interval is
/// too low (docs/notes/2026-11-24-paired-intervals.md).
/// @param here, there  all runs, including those of pairs
/// @throws std::invalid_argument unless 0 < confidence < 1
LengthRatio fit_length_ratio(std::span<const Observation> here, std::span<const Observation> there,
                             std::span<const Pair> pairs, double confidence = 0.95);

}  // namespace clog::fit

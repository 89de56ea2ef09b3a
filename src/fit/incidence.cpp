#include "clog/fit/incidence.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "clog/fit/survival.hpp"

namespace clog::fit {
namespace {

/// The runs that end at one distance.
struct Ends {
  double at_risk;
  double all, own;  ///< number of ends by any cause, and by the given cause
};

/// Sums over all distances so far, for the variance of F_c. Let g = d/(n (n - d)) for all causes together,
/// and let h = P d_c/n^2. The variance is the sum of (F - F_s)^2 g + P h (n - d_c)/n - 2 (F - F_s) h, where
/// F_s is the value of F_c at the distance of the term, and F the present value.
struct VarianceSums {
  double g = 0, F_g = 0, F2_g = 0;
  double own = 0;
  double h = 0, F_h = 0;

  /// @param before  P before these ends @param F  value of F_c after these ends
  void add(double before, double F, const Ends& ends) {
    // If all runs at risk end here, F no longer grows, so the term (F - F_s)^2 g is zero.
    if (ends.all < ends.at_risk) {
      const double g_s = ends.all / (ends.at_risk * (ends.at_risk - ends.all));
      g += g_s, F_g += F * g_s, F2_g += F * F * g_s;
    }
    const double h_s = before * ends.own / (ends.at_risk * ends.at_risk);
    own += before * h_s * (ends.at_risk - ends.own) / ends.at_risk;
    h += h_s, F_h += F * h_s;
  }
  double variance(double F) const {
    return std::max(0.0, F * F * g - 2 * F * F_g + F2_g + own - 2 * (F * h - F_h));
  }
};

}  // namespace

std::vector<IncidenceStep> cumulative_incidence(std::span<const CompetingEnd> runs, int cause,
                                                double confidence) {
  require_confidence(confidence);
  std::vector<CompetingEnd> sorted;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(sorted),
               [](const CompetingEnd& run) { return !std::isnan(run.distance); });
  std::ranges::sort(sorted, {}, &CompetingEnd::distance);
  std::vector<IncidenceStep> steps;
  double still_going = 1, incidence = 0;
  VarianceSums sums;
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    Ends ends = {.at_risk = static_cast<double>(sorted.size() - begin), .all = 0, .own = 0};
    for (; end < sorted.size() && sorted[end].distance == sorted[begin].distance; ++end) {
      ends.all += sorted[end].cause.has_value();
      ends.own += sorted[end].cause == cause;
    }
    incidence += still_going * ends.own / ends.at_risk;
    sums.add(still_going, incidence, ends);
    still_going *= 1 - ends.all / ends.at_risk;
    if (ends.own == 0) continue;
    const double variance = sums.variance(incidence);
    steps.push_back({sorted[begin].distance, static_cast<int>(ends.at_risk), static_cast<int>(ends.own),
                     incidence, std::sqrt(variance),
                     log_log_interval(incidence, variance / (incidence * incidence), confidence)});
  }
  return steps;
}

}  // namespace clog::fit

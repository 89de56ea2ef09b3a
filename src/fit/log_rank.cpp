#include "clog/fit/log_rank.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>
#include <vector>

namespace clog::fit {
namespace {

struct SidedRun {
  Observation run;
  bool is_here;
};

std::vector<SidedRun> sorted_runs(std::span<const Observation> here, std::span<const Observation> there) {
  std::vector<SidedRun> all;
  for (const Observation& run : here) all.push_back({run, true});
  for (const Observation& run : there) all.push_back({run, false});
  std::erase_if(all, [](const SidedRun& one) { return std::isnan(one.run.distance); });
  std::ranges::sort(all, {}, [](const SidedRun& one) { return one.run.distance; });
  return all;
}

}  // namespace

double log_rank_p_value(std::span<const Observation> here, std::span<const Observation> there) {
  const std::vector<SidedRun> all = sorted_runs(here, there);
  auto at_risk_here = static_cast<double>(std::ranges::count(all, true, &SidedRun::is_here));
  auto at_risk = static_cast<double>(all.size());
  double excess = 0, variance = 0;  // of the number of clogs here; sums over all distances with clogs
  for (auto begin = all.begin(), end = begin; begin != all.end(); begin = end) {
    double clogs = 0, clogs_here = 0, runs = 0, runs_here = 0;
    for (; end != all.end() && end->run.distance == begin->run.distance; ++end) {
      clogs += end->run.clogged;
      clogs_here += end->run.clogged && end->is_here;
      runs += 1;
      runs_here += end->is_here;
    }
    const double share = at_risk_here / at_risk;
    excess += clogs_here - clogs * share;
    if (at_risk > 1) variance += clogs * share * (1 - share) * (at_risk - clogs) / (at_risk - 1);
    at_risk -= runs;
    at_risk_here -= runs_here;
  }
  if (!(variance > 0)) return std::numeric_limits<double>::quiet_NaN();
  return cdf(complement(boost::math::chi_squared(1), excess * excess / variance));
}

}  // namespace clog::fit

#include "clog/sweep/single_run.hpp"

#include <algorithm>

#include "clog/core/tools/error.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/value_list.hpp"

namespace clog::sweep {

RunParameters single_run(const Settings& settings) {
  const Plan plan(settings);
  if (plan.size() != 1)
    throw Error(
        "these settings mean " + std::to_string(plan.size()) +
        " runs, one is wanted; give single values, with a point where they have decimals, or use clogsweep");
  return plan.task(0);
}

RunParameters channel_run(Settings settings, const ChannelParameters& channel) {
  // What `auto` must hold off are the tips.
  settings.set("obstacle-diameter", shortest(std::max(2 * channel.tip_radius, 1e-3)));
  return single_run(settings);
}

}  // namespace clog::sweep

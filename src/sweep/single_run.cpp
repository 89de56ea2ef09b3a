#include "clog/sweep/single_run.hpp"

#include "clog/core/tools/error.hpp"
#include "clog/sweep/plan.hpp"

namespace clog::sweep {

RunParameters single_run(const Settings& settings) {
  const Plan plan(settings);
  if (plan.size() != 1)
    throw Error("these settings describe " + std::to_string(plan.size()) +
                " runs, but one is needed; give single values, with a point where they have decimals, or use "
                "clogsweep");
  return plan.task(0);
}

}  // namespace clog::sweep

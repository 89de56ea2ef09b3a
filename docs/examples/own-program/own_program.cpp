/// Your own program: a few droplets among obstacles, and their clogging length.

#include <cstdio>
#include <vector>

#include "clog/core/run/droplet_run.hpp"
#include "clog/fit/clogging_length.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/settings.hpp"

int main() {
  clog::sweep::Settings settings;  // the keys of clogsweep, as text
  settings.set("line-tension", "0.5");
  settings.set("obstacle-gap", "0.3");
  settings.set("obstacle-density", "saturated");
  settings.set("vertices", "64");
  settings.set("box", "20");
  settings.set("max-time", "200");
  settings.set("seeds", "1..4");

  const clog::sweep::Plan plan(settings);
  std::vector<clog::fit::Observation> droplets;
  for (std::int64_t task = 0; task < plan.size(); ++task) {
    clog::DropletRun run(plan.task(task));
    while (!run.advance(100)) {
      // Here one may look at run.droplet() and run.obstacles().
    }
    const clog::RunResult result = run.result();
    const bool clogged = result.status == clog::RunStatus::clogged;
    std::printf("seed %d: %s after %.17g sigma\n", static_cast<int>(task + 1),
                clogged ? "clogged" : "flowing", result.distance);
    droplets.push_back({result.distance, clogged});
  }
  const clog::fit::CloggingLength found = clog::fit::fit_clogging_length(droplets);
  std::printf("lambda = %.3g sigma (95 %%: %.3g to %.3g)\n", found.length, found.interval.lower,
              found.interval.upper);
}

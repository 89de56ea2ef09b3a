#include "clog/core/droplet/time_step.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "clog/core/parameters/schema.hpp"
#include "clog/core/tools/units.hpp"
#include "core/parameters/refusal.hpp"

namespace clog {

double relaxation_time(const RunParameters& run) {
  return run.dp.inertia * run.drag.terminal_speed / units::gravity;
}

double drag_time_step(const RunParameters& run) {
  const bool is_stronger_somewhere = run.drag.near_wall > 0 || run.drag.relative > 1;
  // On walls the edges of an elastic interface get short, and longer steps would have to be split.
  const bool is_elastic = run.model == Model::dp && run.dp.perimeter_spring != PerimeterSpring::along;
  return (is_stronger_somewhere || is_elastic ? 0.1 : 0.2) * relaxation_time(run);
}

void choose_time_step(RunParameters& run, double time_step, std::vector<Rate> rates) {
  run.time_step = time_step;
  if (time_step >= parameter("time-step").range.lower->value) return;
  const double time = relaxation_time(run);
  rates.insert(rates.begin(), {"terminal-speed", run.drag.terminal_speed, 100 / (time * time)});
  const Rate& fastest = *std::max_element(rates.begin(), rates.end(),
                                          [](const Rate& a, const Rate& b) { return a.squared < b.squared; });
  refuse(fastest.key, fastest.value,
         fmt::format("would need a time-step of {:.3g}) use a value nearer to the usual ones", time_step));
}

void check_time_step(const RunParameters& run) {
  const double time_step = run.time_step.value();
  require(run.max_time >= time_step, "max-time", run.max_time,
          [&] { return fmt::format("shorter than one time-step) use at least {:.3g}", time_step); });
  require(run.max_time / time_step <= 1e15, "max-time", run.max_time,
          [&] { return fmt::format("more than 1e15 steps) use at most {:.3g}", 1e15 * time_step); });
  require(time_step <= relaxation_time(run), "time-step", time_step,
          [&] {
            return fmt::format("does not resolve the drag's relaxation time, {}={:.3g}) try {:.3g}",
                               run.dp.inertia == 1 ? "terminal-speed" : "inertia*terminal-speed",
                               relaxation_time(run), drag_time_step(run));
          },
          {"terminal-speed"});
}

}  // namespace clog

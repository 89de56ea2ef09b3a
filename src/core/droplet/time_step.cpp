#include "clog/core/droplet/time_step.hpp"

#include <algorithm>

#include "clog/core/parameters/schema.hpp"
#include "clog/core/tools/units.hpp"
#include "core/parameters/refusal.hpp"

namespace clog {

double drag_time_step(const RunParameters& run) { return 0.1 * run.drag.terminal_speed / units::gravity; }

void choose_time_step(RunParameters& run, double time_step, std::vector<Rate> rates) {
  run.time_step = time_step;
  if (time_step >= parameter("time-step").range.lower->value) return;
  const double speed = run.drag.terminal_speed;
  rates.insert(rates.begin(), {"terminal-speed", speed, 100 / (speed * speed)});
  const Rate& fastest = *std::max_element(rates.begin(), rates.end(),
                                          [](const Rate& a, const Rate& b) { return a.squared < b.squared; });
  refuse(fastest.key, fastest.value,
         "would need a time-step of " + rounded_text(time_step) + ") use a value nearer to the usual ones");
}

void check_time_step(const RunParameters& run) {
  const double time_step = run.time_step.value();
  require(run.max_time >= time_step, "max-time", run.max_time,
          [&] { return "shorter than one time-step) use at least " + rounded_text(time_step); });
  require(run.max_time / time_step <= 1e15, "max-time", run.max_time,
          [&] { return "more than 1e15 steps) use at most " + rounded_text(1e15 * time_step); });
  require(time_step <= run.drag.terminal_speed, "time-step", time_step, [&] {
    return "does not resolve the drag's relaxation time, terminal-speed=" +
           rounded_text(run.drag.terminal_speed) + ") try " + rounded_text(0.1 * run.drag.terminal_speed);
  });
}

}  // namespace clog

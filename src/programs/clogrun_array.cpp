#include <string>

#include "clog/cli/obstacle_file.hpp"
#include "clog/cli/program.hpp"
#include "clog/console/signals.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/sweep/plan.hpp"
#include "clogrun_commands.hpp"

namespace clog::programs {

int clogrun_array(cli::CommandLine& line) {
  // Everything that can be wrong is found before anything is computed or written.
  const std::string output = line.require("output");
  const Scene* scene = line.settings().scene();
  if (scene && scene->finding != Finding::clogging_length)
    throw Error("obstacle-layout=" + line.settings().text("obstacle-layout") + " is no array; use clogrun " +
                (scene->finding == Finding::sag ? "sag" : "channel"));
  const RunParameters parameters = sweep::single_run(line.settings());
  const auto often = intervals(line, *parameters.time_step);
  store::refuse_unwritable(output);
  if (line.has("write-obstacles")) store::refuse_unwritable(line.get("write-obstacles"));

  single_run::RecordedRun watched(DropletRun(parameters), often);
  if (line.has("dry-run"))
    return single_run::print_preview(line.settings().to_config(), watched.measure_cost());
  if (line.has("write-obstacles"))
    cli::write_obstacles(line.get("write-obstacles"), watched.run().obstacles().obstacles());
  say_what_is_unproven(sweep::Plan(line.settings()));
  console::catch_stop_signals();
  watched.follow();

  store::write_trajectory(output, watched.trajectory(sweep::describe(parameters), cli::origin(line)));
  return report(line, watched);
}

}  // namespace clog::programs

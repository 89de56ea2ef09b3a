#include <string>

#include "clog/cli/program.hpp"
#include "clog/console/signals.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "clog/sweep/plan.hpp"
#include "clogrun_commands.hpp"

namespace clog::programs {
namespace {

void say_what_is_coarse(const RunParameters& run) {
  constexpr int fine = 128;
  if (run.model == Model::dp && *run.dp.vertices < fine)
    console::say("vertices=" + std::to_string(*run.dp.vertices) +
                 " may clog where 128 and more pass (corners of the polygon catch on the wedges' tips); use "
                 "vertices=128 or more");
}

}  // namespace

int clogrun_channel(cli::CommandLine& line) {
  refuse_options(line, "channel", {"write-obstacles"});
  const std::string output = line.require("output");
  const RunParameters parameters = sweep::single_run(line.settings());
  const auto often = intervals(line, *parameters.time_step);
  store::refuse_unwritable(output);

  single_run::RecordedRun watched(DropletRun(parameters), often);
  if (line.has("dry-run"))
    return single_run::print_preview(line.settings().to_config(), watched.measure_cost());
  say_what_is_unproven(sweep::Plan(line.settings()));
  say_what_is_coarse(parameters);
  console::catch_stop_signals();
  watched.follow();
  store::write_trajectory(output, watched.trajectory(sweep::describe(parameters), cli::origin(line)));
  return report(line, watched);
}

}  // namespace clog::programs

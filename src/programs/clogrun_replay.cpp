#include <string>

#include "clog/cli/program.hpp"
#include "clog/console/signals.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/instruction_set.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/sweep/settings.hpp"
#include "clogrun_commands.hpp"

namespace clog::programs {
namespace {

/// The row says all that there is to say of the run.
void refuse_keys(const cli::CommandLine& line) {
  for (const sweep::Key& key : sweep::keys())
    if (line.has(key.name))
      throw Error("clogrun replay takes its parameters from the row, " + key.name +
                  " contradicts it; leave it out, or use clogrun array");
}

}  // namespace

int clogrun_replay(cli::CommandLine& line) {
  refuse_options(line, "replay", {"write-obstacles", "seed"});
  refuse_keys(line);
  if (!line.has("file") || !line.has("task"))
    throw Error("missing sweep file or task; try clogrun replay sweep.h5 0 --output run.h5");
  const std::string output = line.require("output");
  const store::SweepFile file = results::read_with_caution(line.get("file"));
  sweep::RunRow row = results::replayable_row(file, line.get("task"));
  if (line.has("to-rest")) row.parameters.clog_detection = ClogDetection::threshold;
  const auto often = intervals(line, *row.parameters.time_step);
  store::refuse_unwritable(output);

  single_run::RecordedRun watched(DropletRun(row.parameters), often);
  if (line.has("dry-run")) return single_run::print_preview("", watched.measure_cost());
  console::catch_stop_signals();
  watched.follow();
  store::write_trajectory(output, watched.trajectory(sweep::describe(row.parameters), cli::origin(line)));
  return report(line, watched);
}

}  // namespace clog::programs

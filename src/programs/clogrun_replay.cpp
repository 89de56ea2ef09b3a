#include <string>

#include "clog/cli/program.hpp"
#include "clog/core/error.hpp"
#include "clog/core/instruction_set.hpp"
#include "clog/core/systems.hpp"
#include "clog/sweep/settings.hpp"
#include "stored_sweep.hpp"
#include "sweep_input.hpp"
#include "watched_run.hpp"

namespace clog {
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
  refuse_options(line, "replay",
                 {"orifice", "wedge-angle", "tip-radius", "start", "end", "obstacles", "seed"});
  refuse_keys(line);
  if (!line.has("file") || !line.has("task"))
    throw Error("missing sweep file or task; try clogrun replay sweep.h5 0 --output run.h5");
  const std::string output = line.require("output");
  const store::SweepFile file = read_with_caution(line.get("file"));
  sweep::RunRow row = replayable_row(file, line.get("task"));
  if (line.has("to-rest")) row.parameters.clog_detection = ClogDetection::threshold;
  const auto intervals = WatchedRun::intervals(line, *row.parameters.time_step);
  store::refuse_unwritable(output);

  WatchedRun watched(run_in_array(row.parameters), intervals);
  if (line.has("dry-run")) return print_preview("", watched.measure_cost());
  cli::catch_stop_signals();
  watched.follow();
  store::write_trajectory(output, watched.trajectory(sweep::describe(row.parameters), line));
  return watched.report();
}

}  // namespace clog

#include <fmt/core.h>

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "clog/cli/obstacle_file.hpp"
#include "clog/cli/program.hpp"
#include "clog/console/signals.hpp"
#include "clog/console/streams.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "clog/core/scene/scene.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/world/lattice.hpp"
#include "clog/results/repetition.hpp"
#include "clog/results/stored_sweep.hpp"
#include "clog/sweep/plan.hpp"
#include "clog/sweep/settings.hpp"
#include "clog/sweep/value_list.hpp"
#include "clogrun_commands.hpp"

namespace clog::programs {
namespace {

void refuse_unwritable_files(const cli::CommandLine& line) {
  store::refuse_unwritable(line.get("output"));
  if (line.has("write-obstacles")) store::refuse_unwritable(line.get("write-obstacles"));
}

/// Follows a run and writes its trajectory. The caller has already checked the command line for errors.
/// @param config  config that --dry-run prints
/// @param origin  origin of the trajectory
/// @param begin  called before the first step; not called if there is nothing to run
int follow_run(const cli::CommandLine& line, DropletRun run, const std::string& config,
               store::Provenance origin, const std::function<void(const DropletRun&)>& begin) {
  const RunParameters parameters = run.parameters();
  single_run::RecordedRun watched(std::move(run), intervals(line, *parameters.time_step));
  const bool is_lattice = parameters.obstacles.layout == ObstacleLayout::lattice;
  const std::string lattice = is_lattice ? "# " + lattice_text(parameters.obstacles) + '\n' : "";
  if (line.has("dry-run")) return single_run::print_preview(config + lattice, watched.measure_cost());
  begin(watched.run());
  console::catch_stop_signals();
  watched.follow();
  store::write_trajectory(line.get("output"),
                          watched.trajectory(sweep::describe(parameters), std::move(origin)));
  return report(line, watched);
}

int follow_run(const cli::CommandLine& line, const RunParameters& parameters, const std::string& config,
               const std::function<void(const DropletRun&)>& begin) {
  refuse_unwritable_files(line);
  return follow_run(line, DropletRun(parameters), config, cli::origin(line), begin);
}

/// Follows one daughter of the row's family from its birth, in the units of the daughter.
int follow_droplet(const cli::CommandLine& line, const sweep::RunRow& row) {
  refuse_options(line, "replay of a daughter", {"lab", "write-obstacles"});
  const Member& member = results::member_of(row, line.get("droplet"));
  refuse_unwritable_files(line);
  std::optional<DropletRun> run = results::family_of(row).at_birth(member.path);
  if (!run)
    throw Error(fmt::format(
        "cannot follow droplet {} of task {} (it {}); give another path", member.path, row.task,
        member.status == MemberEnd::small ? "is smaller than smallest-daughter" : "failed where it began"));
  console::say(
      fmt::format("clogrun: all lengths and times are in the units of this droplet; its diameter is {:.4g} "
                  "of the ancestor's",
                  member.diameter));
  store::Provenance origin = cli::origin(line);
  origin.emplace_back("droplet", member.path);
  for (const auto& [name, value] : {std::pair{"droplet_diameter", member.diameter},
                                    {"birth_distance", member.birth.distance},
                                    {"birth_lateral", member.birth.lateral},
                                    {"birth_time", member.birth.time}})
    origin.emplace_back(name, sweep::shortest(value));
  return follow_run(line, std::move(*run), "", std::move(origin), [](const DropletRun&) {});
}

void write_obstacles(const cli::CommandLine& line, const DropletRun& run) {
  if (line.has("write-obstacles"))
    cli::write_obstacles(line.get("write-obstacles"), run.obstacles().obstacles());
}

void say_what_is_coarse(const RunParameters& run) {
  constexpr int fine = 128;
  if (run.model == Model::dp && *run.dp.vertices < fine)
    console::say("with vertices=" + std::to_string(*run.dp.vertices) +
                 " a droplet may clog where it passes with 128 or more (corners of the polygon catch on the "
                 "wedges' tips); use "
                 "vertices=128 or more");
}

/// Refuses all keys, because the row determines all parameters of the run.
void refuse_keys(const cli::CommandLine& line) {
  for (const sweep::Key& key : sweep::keys())
    if (line.has(key.name))
      throw Error("clogrun replay takes all parameters from the row; remove " + key.name +
                  ", or use clogrun array");
}

}  // namespace

int clogrun_array(cli::CommandLine& line) {
  const Scene* scene = line.settings().scene();
  if (scene && scene->finding != Finding::clogging_length)
    throw Error("obstacle-layout=" + line.settings().text("obstacle-layout") +
                " is not an array of obstacles; use clogrun " +
                (scene->finding == Finding::sag ? "sag" : "channel"));
  const RunParameters parameters = sweep::single_run(line.settings());
  if (parameters.model == Model::dp && parameters.dp.break_up == BreakUp::daughters)
    console::say("clogrun: the record ends when the droplet breaks up; clogsweep follows its daughters");
  return follow_run(line, parameters, line.settings().to_config(), [&](const DropletRun& run) {
    write_obstacles(line, run);
    warn_of_untested_parameters(sweep::Plan(line.settings()));
  });
}

int clogrun_channel(cli::CommandLine& line) {
  refuse_options(line, "channel", {"write-obstacles"});
  const RunParameters parameters = sweep::single_run(line.settings());
  return follow_run(line, parameters, line.settings().to_config(), [&](const DropletRun&) {
    warn_of_untested_parameters(sweep::Plan(line.settings()));
    say_what_is_coarse(parameters);
  });
}

int clogrun_replay(cli::CommandLine& line) {
  refuse_options(line, "replay", {"seed"});
  refuse_keys(line);
  if (!line.has("file") || !line.has("task"))
    throw Error("missing sweep file or task; try clogrun replay sweep.h5 0 --output run.h5");
  const store::SweepFile file = results::read_with_caution(line.get("file"));
  sweep::RunRow row = results::replayable_row(file, line.get("task"));
  results::use_instruction_set_of(row);
  if (line.has("to-rest")) row.parameters.clog_detection = ClogDetection::threshold;
  if (line.has("droplet")) return follow_droplet(line, row);
  if (scene_of(row.parameters).finding != Finding::clogging_length)
    refuse_options(line, "replay of a channel or a wall", {"write-obstacles"});
  return follow_run(line, row.parameters, "", [&](const DropletRun& run) { write_obstacles(line, run); });
}

}  // namespace clog::programs

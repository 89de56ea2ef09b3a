#include <memory>
#include <string>

#include "clog/cli/obstacle_file.hpp"
#include "clog/cli/program.hpp"
#include "clog/console/signals.hpp"
#include "clog/core/run/systems.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/units.hpp"
#include "clog/sweep/single_run.hpp"
#include "clogrun_commands.hpp"

namespace clog::programs {
namespace {

struct Setup {
  RunParameters parameters;
  std::shared_ptr<const ObstacleArray> own_obstacles;  // empty: sampled from the seed
};

Setup read_setup(cli::CommandLine& line) {
  if (!line.has("obstacles")) return {sweep::single_run(line.settings()), nullptr};
  for (const char* key :
       {"obstacle-gap", "obstacle-density", "obstacle-diameter-spread", "obstacle-layout", "lattice-angle"})
    if (line.has(key))
      throw Error("--obstacles and " + std::string(key) +
                  " contradict each other (the file's own gap, density and layout count); give one of them");
  // One parameter set is needed to read the file (box, default diameter); its gap is then the file's own.
  const RunParameters draft = sweep::single_run(line.settings());
  if (draft.obstacles.layout == ObstacleLayout::lattice || draft.obstacles.diameter_spread > 0)
    throw Error("--obstacles and the config's lattice or mixture contradict each other; give one of them");
  const bool polygon = draft.model == Model::dp;
  auto array = std::make_shared<ObstacleArray>(
      cli::read_obstacles(line.get("obstacles"),
                          {.period = draft.obstacles.period(),
                           .default_diameter = draft.obstacles.diameter,
                           .narrowest_gap = polygon ? units::regular_edge_length(draft.dp.vertices) : 0.0}));
  // Of few obstacles the gap may be wider than a sampled array of this box could have.
  const double widest = draft.obstacles.box / 2 - draft.obstacles.diameter;
  line.settings().set("obstacle-gap", sweep::shortest(std::min(array->smallest_gap(), widest)));
  // The config's density may be more than a sampled array of that gap could have.
  line.settings().set("obstacle-density", "saturated");
  return {sweep::single_run(line.settings()), array};
}

sweep::RunRow row_of(const Setup& setup) {
  if (!setup.own_obstacles) return sweep::describe(setup.parameters);
  RunParameters run = setup.parameters;
  run.obstacles.density =
      static_cast<double>(setup.own_obstacles->obstacles().size()) / run.obstacles.period().area();
  return row_of_scene(run, ObstacleLayout::file);
}

}  // namespace

int clogrun_array(cli::CommandLine& line) {
  refuse_options(line, "array", {"orifice", "wedge-angle", "tip-radius", "start", "end"});
  // Everything that can be wrong is found before anything is computed or written.
  const std::string output = line.require("output");
  const Setup setup = read_setup(line);
  const auto often = intervals(line, *setup.parameters.time_step);
  store::refuse_unwritable(output);
  if (line.has("write-obstacles")) store::refuse_unwritable(line.get("write-obstacles"));

  watch::WatchedRun watched(setup.own_obstacles ? run_in_array(setup.parameters, setup.own_obstacles)
                                                : run_in_array(setup.parameters),
                            often);
  if (line.has("dry-run"))
    return watch::print_preview(line.settings().to_config(false), watched.measure_cost());
  if (line.has("write-obstacles"))
    cli::write_obstacles(line.get("write-obstacles"), watched.run().obstacles().obstacles());
  say_what_is_unproven(sweep::Plan(line.settings()));
  console::catch_stop_signals();
  watched.follow();

  store::write_trajectory(output, watched.trajectory(row_of(setup), cli::origin(line)));
  return watched.report();
}

}  // namespace clog::programs

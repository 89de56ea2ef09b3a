/// clogrun: one droplet, watched closely.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "clog/cli/command_line.hpp"
#include "clog/cli/obstacle_file.hpp"
#include "clog/cli/program.hpp"
#include "clog/core/array_run.hpp"
#include "clog/core/error.hpp"
#include "clog/core/units.hpp"
#include "clog/store/trajectory_file.hpp"
#include "clog/sweep/plan.hpp"

namespace {

using namespace clog;

constexpr const char* program = "clogrun";
constexpr const char* usage = R"(clogrun follows one droplet and writes what happens to it.

  clogrun array --output run.h5 line-tension=0.3 obstacle-gap=0.35 seeds=7
  clogrun array --output run.h5 --obstacles mine.csv box=60 --polygon-interval 1

The same keys and seed as a row of a sweep give that row's run, bit for bit.
)";

cli::CommandLine parse(int argc, char** argv) {
  namespace po = boost::program_options;
  cli::CommandLine line(program, usage, cli::CommandLine::SweepKeys::accepted);
  const auto text = [] { return po::value<std::string>(); };
  line.add_options()("system", text(), "array: a periodic obstacle array")(
      "output", text(), "HDF5 file to make")("seed", text(), "short for seeds=N")(
      "sample-interval", text()->default_value("1"), "time between samples [t0]")(
      "polygon-interval", text(), "also write the polygon this often [t0]")(
      "obstacles", text(),
      "CSV file x,y[,diameter] to use as the array; the droplet starts near (box/2, box/2)")(
      "write-obstacles", text(), "write the array as a CSV file");
  line.add_positional("system", 1);
  line.settings().set("seeds", "1");
  line.parse(argc, argv);
  if (line.has("seed")) line.settings().set("seeds", line.get("seed"));
  return line;
}

struct Setup {
  RunParameters parameters;
  std::shared_ptr<const ObstacleArray> own_obstacles;  // empty: sampled from the seed
};

Setup read_setup(cli::CommandLine& line) {
  if (!line.has("obstacles")) {
    const sweep::Plan plan(line.settings());
    if (plan.size() != 1)
      throw Error("these settings mean " + std::to_string(plan.size()) +
                  " runs, clogrun does one; give single values, or "
                  "use clogsweep");
    return {plan.task(0), nullptr};
  }
  for (const char* key :
       {"obstacle-gap", "obstacle-density", "obstacle-diameter-spread", "obstacle-layout", "lattice-angle"})
    if (line.has(key))
      throw Error("--obstacles and " + std::string(key) + " contradict each other; give one of them");
  // One parameter set is needed to read the file (box, default diameter); its gap is then the file's own.
  const auto single_plan = [&] {
    const sweep::Plan plan(line.settings());
    if (plan.size() != 1)
      throw Error("these settings mean several runs, clogrun does one; give single values");
    return plan.task(0);
  };
  const RunParameters draft = single_plan();
  if (draft.obstacles.layout == ObstacleLayout::lattice || draft.obstacles.diameter_spread > 0)
    throw Error("--obstacles and the config's lattice or mixture contradict each other; give one of them");
  const std::string path = line.get("obstacles");
  const bool polygon = draft.model == Model::dp;
  auto array = std::make_shared<ObstacleArray>(cli::read_obstacles(
      path, {.box = draft.obstacles.box,
             .default_diameter = draft.obstacles.diameter,
             .narrowest_gap = polygon ? units::regular_edge_length(draft.dp.vertices) : 0.0}));
  const double gap = array->smallest_gap();
  line.settings().set("obstacle-gap", sweep::shortest(std::min(gap, draft.obstacles.box)));
  return {single_plan(), array};
}

store::TrajectorySample sample(const ArrayRun& run) {
  const PolygonShape shape = run.droplet().shape();
  const Eigen::Array2d displacement = run.displacement();
  return {.time = run.time(),
          .distance = displacement[0],
          .lateral_displacement = displacement[1],
          .speed = run.droplet().state().mean_velocity()[0],
          .kinetic_energy_ratio = run.kinetic_energy_ratio(),
          .area = shape.area,
          .perimeter = shape.perimeter,
          .shape_parameter = shape.shape_parameter()};
}

store::PolygonFrame polygon(const ArrayRun& run) {
  const DropletState& state = run.droplet().state();
  store::PolygonFrame frame{run.time(), {}};
  for (const int axis : {0, 1})
    for (Eigen::Index i = 0; i < state.size(); ++i)
      frame.position.push_back(state.frame.global({state.x()[i], state.y()[i]})[axis]);
  return frame;
}

/// Obstacles, periodic images included, within a diameter of the polygons.
std::vector<Obstacle> obstacles_along(const std::vector<store::PolygonFrame>& frames,
                                      const ObstacleArray& array) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  ObstacleArray::Window window{0, 0, inf, -inf, inf, -inf, units::droplet_diameter};
  for (const store::PolygonFrame& frame : frames) {
    const std::size_t n = frame.position.size() / 2;
    for (std::size_t i = 0; i < n; ++i) {
      window.x_min = std::min(window.x_min, frame.position[i]);
      window.x_max = std::max(window.x_max, frame.position[i]);
      window.y_min = std::min(window.y_min, frame.position[n + i]);
      window.y_max = std::max(window.y_max, frame.position[n + i]);
    }
  }
  std::vector<Obstacle> obstacles;
  array.gather(window, obstacles);
  return obstacles;
}

/// Follows the run to its end, or to a signal, taking samples; both intervals in checks of the run (0: no
/// polygons).
RunStatus follow(ArrayRun& run, std::int64_t sample_checks, std::int64_t polygon_checks,
                 store::Trajectory& trajectory) {
  std::int64_t checks = 0;
  bool over = false;
  while (true) {
    if (checks % sample_checks == 0 || over) trajectory.samples.push_back(sample(run));
    if (polygon_checks > 0 && (checks % polygon_checks == 0 || over))
      trajectory.polygons.push_back(polygon(run));
    if (over) return run.result().status;
    if (cli::stop_signalled()) return RunStatus::interrupted;
    over = run.advance(1);
    ++checks;
  }
}

/// The number of checks of the run in an interval given by an option, at least one.
std::int64_t in_checks(const cli::CommandLine& line, const char* option, double check_time) {
  constexpr double never = 1e15;
  return std::llround(std::clamp(line.get_positive(option) / check_time, 1.0, never));
}

int run_array(cli::CommandLine& line) {
  // Everything that can be wrong is found before anything is computed or written.
  const std::string output = line.require("output");
  const Setup setup = read_setup(line);
  const double check_time = ArrayRun::steps_per_check * setup.parameters.time_step;
  const std::int64_t sample_checks = in_checks(line, "sample-interval", check_time);
  const std::int64_t polygon_checks =
      line.has("polygon-interval") ? in_checks(line, "polygon-interval", check_time) : 0;
  store::refuse_unwritable(output);
  if (line.has("write-obstacles")) {
    store::refuse_unwritable(line.get("write-obstacles"));
    if (line.get("write-obstacles") == output)
      throw Error("--output and --write-obstacles name the same file, " + output + "; give two names");
  }

  ArrayRun run =
      setup.own_obstacles ? ArrayRun(setup.parameters, setup.own_obstacles) : ArrayRun(setup.parameters);
  if (line.has("write-obstacles"))
    cli::write_obstacles(line.get("write-obstacles"), run.obstacles().obstacles());

  cli::catch_stop_signals();
  store::Trajectory trajectory;
  const auto begin = std::chrono::steady_clock::now();
  const RunStatus status = follow(run, sample_checks, polygon_checks, trajectory);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  RunResult result = run.result();
  result.status = status;
  trajectory.row = sweep::describe(setup.parameters);
  if (setup.own_obstacles) {
    const double box = setup.parameters.obstacles.box;
    trajectory.row.obstacle_filling = "file";
    trajectory.row.obstacle_density =
        static_cast<double>(setup.own_obstacles->obstacles().size()) / (box * box);
  }
  trajectory.row.task = 0;
  trajectory.row.wall_seconds = seconds;
  sweep::record(result, trajectory.row);
  if (!trajectory.polygons.empty())
    trajectory.obstacles = obstacles_along(trajectory.polygons, run.obstacles());
  trajectory.provenance = cli::origin(line);
  trajectory.provenance.emplace_back("hdf5_version", store::library_version());
  store::write_trajectory(output, trajectory);

  std::printf("%s after r = %.4f sigma, t = %.4g t0, E_k/E_t = %.2g, A = %.4f\n", name(status),
              result.distance, result.time, result.kinetic_energy_ratio, result.shape_parameter);
  if (!result.message.empty()) std::printf("%s\n", result.message.c_str());
  const auto vertex_steps = static_cast<double>(result.steps) * static_cast<double>(trajectory.row.vertices);
  std::printf("%lld steps, %.3f s, %.2f ns per vertex-step\n", static_cast<long long>(result.steps), seconds,
              1e9 * seconds / vertex_steps);
  return status == RunStatus::interrupted ? cli::exit_incomplete
         : status == RunStatus::failed    ? cli::exit_internal_fault
                                          : cli::exit_success;
}

int body(int argc, char** argv) {
  cli::CommandLine line = parse(argc, argv);
  if (cli::answer_help_or_version(line, {{"HDF5", store::library_version()}})) return cli::exit_success;
  const std::string system = line.has("system") ? line.get("system") : "";
  if (system != "array")
    throw Error((system.empty() ? "missing system" : "unknown system '" + system + "'") +
                "; try clogrun array");
  return run_array(line);
}

}  // namespace

int main(int argc, char** argv) {
  return clog::cli::run_program(program, [&] { return body(argc, argv); });
}

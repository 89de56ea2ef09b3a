/// Measures the cost of a step. The values of `time per vertex-step` can be compared only within one
/// execution of this program.

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "clog/core/polygon/neck.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/core/tools/instruction_set.hpp"

namespace {

using namespace clog;

RunParameters flowing_droplet(int vertices, double near_wall_drag) {
  RunParameters run;
  run.dp.vertices = vertices;
  run.drag.near_wall = near_wall_drag;
  run.obstacles.gap = 1;
  run.obstacles.box = 60;
  run.time_step = vertices > 256 ? 2.5e-4 : 1e-3;
  run.max_time = 1e9;
  run.clog_detection = ClogDetection::threshold;
  run.clog_energy = 1e-300;
  return resolve(run);
}

void count_steps(benchmark::State& state, std::int64_t num_steps, int points) {
  const auto steps = static_cast<double>(num_steps);
  state.counters["steps/s"] = benchmark::Counter(steps, benchmark::Counter::kIsRate);
  state.counters["time per vertex-step"] =
      benchmark::Counter(steps * points, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void advance(benchmark::State& state, const RunParameters& parameters) {
  DropletRun run(parameters);
  run.advance(100);
  const std::int64_t before = run.result().steps;
  for ([[maybe_unused]] auto _ : state) run.advance(100);
  count_steps(state, run.result().steps - before,
              parameters.model == Model::dp ? *parameters.dp.vertices : 1);
}

void with_instruction_set(benchmark::State& state, const std::string& set) {
  try {
    use_instruction_set(set);
  } catch (const Error& error) {
    state.SkipWithError(error.what());
    return;
  }
  advance(state, flowing_droplet(256, 0));
  use_instruction_set("auto");
}

void polygon(benchmark::State& state) {
  advance(state, flowing_droplet(static_cast<int>(state.range(0)), 0));
}
BENCHMARK(polygon)
    ->ArgName("vertices")
    ->Arg(64)
    ->Arg(128)
    ->Arg(256)
    ->Arg(512)
    ->Arg(1024)
    ->Unit(benchmark::kMillisecond);

void polygon_avx2(benchmark::State& state) { with_instruction_set(state, "avx2"); }
BENCHMARK(polygon_avx2)->Unit(benchmark::kMillisecond);
void polygon_baseline(benchmark::State& state) { with_instruction_set(state, "baseline"); }
BENCHMARK(polygon_baseline)->Unit(benchmark::kMillisecond);

/// An interface with springs to the mean length of the edges, and with weight and drag on single vertices.
void heavy_interface(benchmark::State& state) {
  RunParameters run =
      flowing_droplet(static_cast<int>(state.range(0)), 0.01 * static_cast<double>(state.range(1)));
  run.dp.perimeter_spring = PerimeterSpring::mean;
  run.dp.perimeter_stiffness.reset();
  run.dp.gravity = Gravity::vertex;
  advance(state, resolve(run));
}
BENCHMARK(heavy_interface)
    ->ArgNames({"vertices", "near_wall_drag_percent"})
    ->Args({64, 0})
    ->Args({256, 0})
    ->Args({1024, 0})
    ->Args({256, 20})
    ->Unit(benchmark::kMillisecond);

void polygon_with_near_wall_drag(benchmark::State& state) { advance(state, flowing_droplet(256, 0.2)); }
BENCHMARK(polygon_with_near_wall_drag)->Unit(benchmark::kMillisecond);

void wrapped_polygon(benchmark::State& state) {
  RunParameters run = flowing_droplet(256, 0);
  run.dp.line_tension = 0.2;
  run.obstacles.gap = 0.2;
  advance(state, resolve(run));
}
BENCHMARK(wrapped_polygon)->Unit(benchmark::kMillisecond);

/// The search for necks (break-up-neck) in a soft droplet that moves. A run searches once in
/// DropletRun::steps_per_check steps.
void neck_of_a_droplet(benchmark::State& state) {
  RunParameters run = flowing_droplet(static_cast<int>(state.range(0)), 0);
  run.dp.line_tension = 0.05;
  run.obstacles.gap = 0.2;
  DropletRun droplet(resolve(run));
  std::vector<Eigen::ArrayXd> shapes;
  while (shapes.size() < 200 && !droplet.advance(100)) shapes.push_back(droplet.droplet().state().position);
  std::size_t which = 0;
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(thinnest_neck(shapes[which++ % shapes.size()]));
}
BENCHMARK(neck_of_a_droplet)->ArgName("vertices")->Arg(128)->Arg(512)->Unit(benchmark::kMicrosecond);

/// The settings of the figures: the elastic interface, the automatic step, and gaps that the droplet passes
/// by wrapping around obstacles.
void elastic_polygon(benchmark::State& state) {
  RunParameters run;
  run.dp.vertices = 128;
  run.dp.line_tension = 0.01 * static_cast<double>(state.range(0));
  run.dp.perimeter_spring = PerimeterSpring::rest;
  run.dp.perimeter_stiffness = 0.1 * run.dp.line_tension;
  run.dp.gravity = Gravity::vertex;
  run.obstacles.gap = 0.4;
  run.obstacles.box = 60;
  run.max_time = 1e9;
  run.clog_detection = ClogDetection::threshold;
  run.clog_energy = 1e-300;
  advance(state, resolve(run));
}
BENCHMARK(elastic_polygon)
    ->ArgName("line_tension_percent")
    ->Arg(2)
    ->Arg(10)
    ->Arg(30)
    ->Unit(benchmark::kMillisecond);

/// A droplet that approaches a channel and passes it. As in clogrun, each step also computes the work against
/// the drag.
void polygon_in_channel(benchmark::State& state) {
  RunParameters run = flowing_droplet(256, 0.01 * static_cast<double>(state.range(0)));
  run.drag.terminal_speed = 0.032;
  run.obstacles = {};
  run.obstacles.layout = ObstacleLayout::channel;
  run.channel.start = -2;
  run = resolve(run);
  std::int64_t steps = 0;
  for ([[maybe_unused]] auto _ : state) {
    DropletRun passage(run);
    passage.measure_dissipation();
    passage.advance(1'000'000);
    steps += passage.result().steps;
  }
  count_steps(state, steps, *run.dp.vertices);
}
BENCHMARK(polygon_in_channel)
    ->ArgName("near_wall_drag_percent")
    ->Arg(0)
    ->Arg(7)
    ->Unit(benchmark::kMillisecond);

void soft_disk(benchmark::State& state) {
  RunParameters run = flowing_droplet(256, 0);
  run.model = Model::sp;
  run.dp = {};
  run.wall_stiffness = 1;
  run.obstacles.gap = 0.2;
  advance(state, resolve(run));
}
BENCHMARK(soft_disk)->Unit(benchmark::kMillisecond);

void sample_saturated_array(benchmark::State& state) {
  const ObstacleParameters parameters{
      .gap = 0.2, .diameter = 0.3, .density = {}, .box = static_cast<double>(state.range(0))};
  std::uint32_t seed = 0;
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(sample_obstacles(parameters, ++seed));
}
BENCHMARK(sample_saturated_array)->ArgName("box")->Arg(100)->Arg(500)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
